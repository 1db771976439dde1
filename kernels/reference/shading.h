// Scalar twin of kernels/shading-inl.h.
#pragma once

#include "core/plan.h"
#include "core/plan_connections.h"
#include "core/plan_light_paths.h"
#include "kernels/reference/vec3.h"

namespace lanewise::reference {

template <class T>
Vec3<T> viewer_side(const Vec3<T>& s, const Vec3<T>& d) {
  return glm::dot(d, s) > 0 ? -s : s;
}

template <class T>
const PlanMaterial& material_at(const Plan& plan, const Path<T>& p) {
  return plan.materials[plan.prim_material[p.prim]];
}

// Radiance of the light times w / (n l_pdf), w the power heuristic's weight against bsdf_pdf; needs l_pdf > 0. Of a
// connection w is 1, or 0 where directions are left to BSDF sampling.
template <class T>
Vec3<T> light_weight(const Plan& plan, const Path<T>& p, T bsdf_pdf) {
  const Direct direct = plan.settings.direct;
  const T n_pdf = static_cast<T>(plan.settings.light_samples) * p.l_pdf;
  const Vec3<T> radiance = direct == Direct::kHemisphere        ? Vec3<T>(1)
                           : is_environment(plan, p.step.light) ? LANEWISE_RGB(p, c)
                                                                : vec3<T>(plan.lights[p.step.light].radiance);
  if (p.step.connection) return bsdf_pdf <= T(kMostConnectedPdf) ? radiance / n_pdf : Vec3<T>(0);
  const T ratio = direct == Direct::kMis ? bsdf_pdf / n_pdf : 0;
  return radiance / (n_pdf * (1 + ratio * ratio));
}

// What pdf becomes after a delta lobe: see kConnected. reflects_outside: the lobe is the reflection, seen from outside.
template <class T>
T pdf_after_delta(const Plan& plan, const Path<T>& p, bool reflects_outside) {
  const bool counted = connects(plan) && p.pdf > 0 && p.pdf <= T(kMostConnectedPdf);
  return counted && reflects_outside && p.prim >= plan.triangles ? T(kConnected) : T(0);
}

// Whether the direction agrees with both normals of the surface: see core/plan_light_paths.h.
template <class T>
bool agrees(const Path<T>& p, const Vec3<T>& w) {
  const T geometric = std::abs(glm::dot(w, LANEWISE_VEC3(p, n))), shading = std::abs(glm::dot(w, LANEWISE_VEC3(p, s)));
  return geometric >= T(kLeastAgreement) * shading && shading >= T(kLeastAgreement) * geometric;
}

// Whether light paths are not for ways in this direction, that of a light sample.
template <class T>
bool disagrees(const Plan& plan, const Path<T>& p, const Vec3<T>& l) {
  return has_light_paths(plan) && !plan.prim_normals.empty() && !agrees(p, l);
}

// Whether the path looks for light step.light, in direction l, itself, or light paths bring what it sends.
template <class T>
bool looks_for_light(const Plan& plan, const Path<T>& p, const Vec3<T>& l) {
  return is_environment(plan, p.step.light) || !has_light_paths(plan) || p.lamps != kByLightPaths ||
         disagrees(plan, p, l);
}

// What refraction multiplies radiance by, eta the index on the side of its viewer over that beyond.
template <class T>
T squeeze(const Step& step, T eta) {
  return step.from_light ? T(1) : eta * eta;
}

// Sends the path on from the hit point in direction wi.
template <class T>
void leave(Path<T>& p, const Vec3<T>& wi, const Vec3<T>& weight, T pdf) {
  LANEWISE_SET_RGB(p, beta, LANEWISE_RGB(p, beta) * weight);
  LANEWISE_SET_VEC3(p, o, offset_origin(LANEWISE_VEC3(p, o), LANEWISE_VEC3(p, n), p.err, wi));
  LANEWISE_SET_VEC3(p, d, wi);
  p.pdf = pdf;
}

}  // namespace lanewise::reference
