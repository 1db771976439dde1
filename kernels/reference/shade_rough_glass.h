// Scalar twin of kernels/shade_rough_glass.cc: Walter, Marschner, Li & Torrance, Microfacet Models for Refraction through Rough
// Surfaces (EGSR 2007), with visible normals.
#pragma once

#include "kernels/reference/shade_microfacet.h"

namespace lanewise::reference {

// The glass as seen from one side: n_i is the index there, n_t that beyond.
template <class T>
struct RoughGlass {
  T n_i, n_t, alpha;

  RoughGlass(const PlanMaterial& material, bool inside)
      : n_i(inside ? material.ior : T(1)), n_t(inside ? T(1) : material.ior), alpha(alpha_of<T>(material)) {}

  // Density per steradian of wi, in the frame of the normal on wo's side: each direction is either reflected or refracted, by
  // one microfacet m. slopes: those of m; c, cos_t: cosines of wo and of the refracted direction at m.
  T reflected_pdf(Fresnel model, const Vec3<T>& wo, T tan2, T c) const {
    return fresnel_dielectric(model, c, n_i, n_t).reflectance * visible(wo, tan2) / 4;
  }
  T refracted_pdf(Fresnel model, const Vec3<T>& wo, T tan2, T c, T cos_t) const {
    const T e = std::max(std::abs((n_t - n_i) * (n_t + n_i)), T(1e-6f));
    const T h = e / (n_i * c + n_t * cos_t);         // |n_t cos_t - n_i c|, by Snell's law
    const T jacobian = n_t * n_t * cos_t / (h * h);  // of m by wi, eq. 17
    return fresnel_dielectric(model, c, n_i, n_t).transmittance * visible(wo, tan2) * c * jacobian;
  }

 private:
  // Density of the visible normals over wo.m.
  T visible(const Vec3<T>& wo, T tan2) const { return beckmann_d(tan2, alpha) * view_slopes(wo, alpha).g1_over_cos(); }
};

// Of a pair of directions in the frame of the normal, wo.z >= 0: f |cos|, without tint and the squeeze of radiance, and wi's
// density.
template <class T>
struct RoughGlassPair {
  T f_cos, pdf;
};

template <class T>
RoughGlassPair<T> evaluate_rough_glass(Fresnel model, const RoughGlass<T>& glass, const Vec3<T>& wo,
                                       const Vec3<T>& wi) {
  const bool reflects = wi.z > 0;
  const T side = glass.n_t > glass.n_i ? -1 : 1;  // the microfacet's normal is on the side of the smaller index
  const Vec3<T> h = reflects ? wo + wi : side * (glass.n_i * wo + glass.n_t * wi);
  const T z = std::max(h.z, T(1e-6f)), across2 = h.x * h.x + h.y * h.y, tan2 = across2 / (z * z);
  const T length2 = z * z + across2, length = std::sqrt(length2);
  RoughGlassPair<T> pair{};
  if (reflects) {
    pair.pdf = glass.reflected_pdf(model, wo, tan2, std::min(length / 2, T(1)));
  } else {
    const T e = std::max(std::abs((glass.n_t - glass.n_i) * (glass.n_t + glass.n_i)), T(1e-6f));
    if (!(h.z > 0 && length2 < e)) return pair;
    const T c = std::min((e / length + side * length) / (2 * glass.n_i), T(1));
    const T cos_t = std::min((e / length - side * length) / (2 * glass.n_t), T(1));
    pair.pdf = glass.refracted_pdf(model, wo, tan2, c, cos_t);
  }
  const Vec3<T> above(wi.x, wi.y, std::abs(wi.z));
  pair.f_cos = pair.pdf * view_slopes(above, glass.alpha).g1();
  return pair;
}

template <class T>
Vec3<T> rough_glass_tint(const PlanMaterial& material, const RoughGlass<T>& glass, bool reflects, const Step& step) {
  const T eta = glass.n_i / glass.n_t;
  return reflects ? vec3<T>(material.reflectance) : squeeze(step, eta) * vec3<T>(material.transmittance);
}

template <class T>
void light_rough_glass(const Plan& plan, Path<T>& p) {
  const Vec3<T> d = LANEWISE_VEC3(p, d), outward = LANEWISE_VEC3(p, s), normal = viewer_side(outward, d);
  const Vec3<T> l = glm::normalize(LANEWISE_VEC3(p, l));
  const PlanMaterial& material = material_at(plan, p);
  const RoughGlass<T> glass(material, glm::dot(d, outward) > 0);
  Vec3<T> b1, b2, c(0);
  frame(normal, b1, b2);
  const auto local = [&](const Vec3<T>& w) { return Vec3<T>(glm::dot(w, b1), glm::dot(w, b2), glm::dot(w, normal)); };
  Vec3<T> wo = local(-d);
  wo.z = std::max(wo.z, T(0));
  const Vec3<T> wi = local(l);
  if (p.l_pdf > 0 && looks_for_light(plan, p, l)) {
    const auto pair = evaluate_rough_glass(plan.settings.fresnel, glass, wo, wi);
    if (pair.pdf > 0) {
      c = LANEWISE_RGB(p, beta) * rough_glass_tint(material, glass, wi.z > 0, p.step) * pair.f_cos *
          light_weight(plan, p, pair.pdf);
    }
  }
  LANEWISE_SET_RGB(p, c, c);
}

template <class T>
void shade_rough_glass(const Plan& plan, Path<T>& p) {
  const Vec3<T> d = LANEWISE_VEC3(p, d), outward = LANEWISE_VEC3(p, s), normal = viewer_side(outward, d);
  const PlanMaterial& material = material_at(plan, p);
  const Fresnel model = plan.settings.fresnel;
  const RoughGlass<T> glass(material, glm::dot(d, outward) > 0);
  Vec3<T> b1, b2;
  frame(normal, b1, b2);
  const Vec3<T> wo(-glm::dot(d, b1), -glm::dot(d, b2), std::max(-glm::dot(d, normal), T(0)));

  const auto [u, v] = draw_facet(plan, p);
  const Slopes<T> slopes = sample_visible_normal(wo, glass.alpha, u, v);
  const T tan2 = glm::dot(slopes, slopes);
  const Vec3<T> m = Vec3<T>(slopes.x, slopes.y, 1) / std::sqrt(1 + tan2);
  const T c = std::clamp(glm::dot(wo, m), T(0), T(1));
  const Dielectric<T> fresnel = fresnel_dielectric(model, c, glass.n_i, glass.n_t);
  const bool reflects = draw_random(plan, p, kSetChoice).u[kDrawLobe] < fresnel.reflectance;
  const T eta = glass.n_i / glass.n_t;
  const Vec3<T> wi = reflects ? 2 * c * m - wo : (eta * c - fresnel.cos_t) * m - eta * wo;
  const bool leaves = c > 0 && (reflects ? wi.z > 0 : wi.z < 0);

  const T weight = view_slopes(Vec3<T>(wi.x, wi.y, std::abs(wi.z)), glass.alpha).g1();
  // -H looks for lights on the viewer's side alone: beyond, they are met as behind a delta lobe.
  const bool alone = !reflects && plan.settings.direct == Direct::kHemisphere;
  const T pdf = reflects ? glass.reflected_pdf(model, wo, tan2, c)
                : alone  ? T(0)
                         : glass.refracted_pdf(model, wo, tan2, c, fresnel.cos_t);
  leave(p, glm::normalize(to_world(wi, b1, b2, normal)),
        leaves ? weight * rough_glass_tint(material, glass, reflects, p.step) : Vec3<T>(0), leaves ? pdf : T(0));
}

}  // namespace lanewise::reference
