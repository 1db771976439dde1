#pragma once

#include "kernels/reference/fresnel.h"
#include "kernels/reference/rng.h"
#include "kernels/reference/shading.h"

namespace lanewise::reference {

template <class T>
void shade_glass(const Plan& plan, Path<T>& p) {
  const PlanMaterial& material = material_at(plan, p);
  const Vec3<T> d = LANEWISE_VEC3(p, d), outward = LANEWISE_VEC3(p, s);
  const Vec3<T> normal = viewer_side(outward, d);
  const bool inside = glm::dot(d, outward) > 0;
  const T c = std::min(std::abs(glm::dot(d, outward)), T(1));
  const T n_i = inside ? material.ior : T(1), n_t = inside ? T(1) : material.ior;
  const Dielectric<T> fresnel = fresnel_dielectric(plan.settings.fresnel, c, n_i, n_t);
  const T eta = n_i / n_t;
  if (draw_glass_lobe(plan, p) < fresnel.reflectance) {
    leave(p, glm::normalize(d + 2 * c * normal), vec3<T>(material.reflectance), pdf_after_delta(plan, p, !inside));
  } else {
    leave(p, glm::normalize(eta * d + (eta * c - fresnel.cos_t) * normal),
          squeeze(p.step, eta) * vec3<T>(material.transmittance), pdf_after_delta(plan, p, false));
  }
}

}  // namespace lanewise::reference
