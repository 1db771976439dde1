#pragma once

#include "kernels/reference/rng.h"
#include "kernels/reference/sampling.h"
#include "kernels/reference/shading.h"

namespace lanewise::reference {

template <class T>
void light_lambertian(const Plan& plan, Path<T>& p, const Vec3<T>& albedo) {
  const Vec3<T> normal = viewer_side(LANEWISE_VEC3(p, s), LANEWISE_VEC3(p, d));
  const Vec3<T> l = LANEWISE_VEC3(p, l);
  const T cosine = glm::dot(l, normal) / glm::length(l);
  Vec3<T> c(0);
  if (cosine > 0 && p.l_pdf > 0) {
    const T pdf = cosine * std::numbers::inv_pi_v<T>;
    const Vec3<T> f_cos = pdf * albedo;
    c = LANEWISE_RGB(p, beta) * f_cos * light_weight(plan, p, pdf);
  }
  LANEWISE_SET_RGB(p, c, c);
}

template <class T>
void shade_lambertian(const Plan& plan, Path<T>& p, const Vec3<T>& albedo) {
  const Vec3<T> normal = viewer_side(LANEWISE_VEC3(p, s), LANEWISE_VEC3(p, d));
  const auto random = draw_direction(plan, p);
  const Vec3<T> local = cosine_hemisphere(random.u[kDrawU], random.u[kDrawV]);
  Vec3<T> b1, b2;
  frame(normal, b1, b2);
  leave(p, to_world(local, b1, b2, normal), albedo, local.z * std::numbers::inv_pi_v<T>);
}

template <class T>
void light_diffuse(const Plan& plan, Path<T>& p) {
  light_lambertian(plan, p, vec3<T>(material_at(plan, p).reflectance));
}
template <class T>
void light_textured(const Plan& plan, Path<T>& p) {
  light_lambertian(plan, p, LANEWISE_RGB(p, a));
}
template <class T>
void shade_diffuse(const Plan& plan, Path<T>& p) {
  shade_lambertian(plan, p, vec3<T>(material_at(plan, p).reflectance));
}
template <class T>
void shade_textured(const Plan& plan, Path<T>& p) {
  shade_lambertian(plan, p, LANEWISE_RGB(p, a));
}

}  // namespace lanewise::reference
