#pragma once

#include "kernels/kernels.h"
#include "kernels/reference/vec3.h"

namespace lanewise::reference {

template <class T>
void emission(const Plan& plan, Path<T>& p) {
  const float* shape = &plan.prim_shape[size_t{4} * p.prim];
  const Vec3<T> d = LANEWISE_VEC3(p, d);
  Vec3<T> n = vec3<T>(shape);
  if (p.prim >= plan.triangles) n = glm::normalize(LANEWISE_VEC3(p, o) + p.t * d - n);
  const T cosine = -glm::dot(n, d);
  if (!(cosine > 0) || p.pdf == T(kConnected) || p.lamps == kByLightPaths) return;

  const PlanLight& light = plan.lights[plan.prim_light[p.prim]];
  const bool alone = p.pdf == 0;
  T weight = 1;
  if (plan.settings.direct == Direct::kMis && !alone) {
    const T light_pdf = T(plan.settings.light_samples) * p.t * p.t / (T(light.area) * cosine);
    const T ratio = light_pdf / p.pdf;
    weight = 1 / (1 + ratio * ratio);
  } else if (plan.settings.direct == Direct::kLight || plan.settings.direct == Direct::kHemisphere) {
    weight = alone ? 1 : 0;
  }
  LANEWISE_SET_RGB(p, L, LANEWISE_RGB(p, L) + weight * (LANEWISE_RGB(p, beta) * vec3<T>(light.radiance)));
}

}  // namespace lanewise::reference
