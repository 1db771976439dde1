#pragma once

#include <cmath>
#include <numbers>

#include "kernels/kernels.h"
#include "kernels/reference/rng.h"
#include "kernels/reference/vec3.h"

namespace lanewise::reference {

// p.pixel, p.sample and p.slot say which path; the kernel takes them from the batch.
template <class T>
void generate(const Plan& plan, Path<T>& p) {
  const PlanCamera& camera = plan.camera;
  const Random4<T> random = draw_random(plan, p, kSetPath);
  const T x = T(p.pixel % plan.settings.width) + random.u[kDrawU] - T(0.5) * T(plan.settings.width);
  const T y = T(0.5) * T(plan.settings.height) - (T(p.pixel / plan.settings.width) + random.u[kDrawV]);
  const T pixel = T(camera.pixel);
  const Vec3<T> right = vec3<T>(camera.right), up = vec3<T>(camera.up), forward = vec3<T>(camera.forward);
  Vec3<T> o = vec3<T>(camera.eye), d = x * pixel * right + y * pixel * up + forward;
  if (camera.lens_radius > 0) {
    const Random4<T> on_lens = draw_random(plan, p, kSetLens);
    const T r = std::sqrt(on_lens.u[kDrawU]), phi = 2 * std::numbers::pi_v<T> * on_lens.u[kDrawV];
    const Vec3<T> on_unit_lens = r * std::cos(phi) * right + r * std::sin(phi) * up;
    o += T(camera.lens_radius) * on_unit_lens;
    d -= T(camera.lens_angle) * on_unit_lens;
  }
  LANEWISE_SET_VEC3(p, o, o);
  LANEWISE_SET_VEC3(p, d, glm::normalize(d));
  LANEWISE_SET_RGB(p, beta, Vec3<T>(1));
  LANEWISE_SET_RGB(p, L, Vec3<T>(0));
  p.pdf = 0;
  p.lamps = kByItself;
}

}  // namespace lanewise::reference
