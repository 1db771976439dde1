#pragma once

#include "kernels/kernels.h"
#include "kernels/reference/rng.h"
#include "kernels/reference/vec3.h"

namespace lanewise::reference {

// p.pixel, p.sample and p.slot say which path; the kernel takes them from the batch.
template <class T>
void generate(const Plan& plan, Path<T>& p) {
  const PlanCamera& camera = plan.camera;
  const Random4<T> random = draw_random(plan, p, kSetCamera);
  const T x = T(p.pixel % plan.settings.width) + random.u[0] - T(0.5) * T(plan.settings.width);
  const T y = T(0.5) * T(plan.settings.height) - (T(p.pixel / plan.settings.width) + random.u[1]);
  const T pixel = T(camera.pixel);
  LANEWISE_SET_VEC3(p, o, vec3<T>(camera.eye));
  LANEWISE_SET_VEC3(
      p, d,
      glm::normalize(x * pixel * vec3<T>(camera.right) + y * pixel * vec3<T>(camera.up) + vec3<T>(camera.forward)));
  LANEWISE_SET_RGB(p, beta, Vec3<T>(1));
  LANEWISE_SET_RGB(p, L, Vec3<T>(0));
  p.pdf = 0;
}

}  // namespace lanewise::reference
