#pragma once

#include "core/plan.h"
#include "kernels/reference/environment_map.h"
#include "kernels/reference/vec3.h"

namespace lanewise::reference {

template <class T>
void environment(const Plan& plan, Path<T>& p) {
  const Sky<T> sky = sky_along(plan.environment, LANEWISE_VEC3(p, d));
  const bool sampled = p.pdf > 0;
  T weight = 1;
  if (plan.settings.direct == Direct::kMis && sampled) {
    const T ratio = T(plan.settings.light_samples) * sky.pdf / p.pdf;
    weight = 1 / (1 + ratio * ratio);
  } else if (plan.settings.direct == Direct::kLight || plan.settings.direct == Direct::kHemisphere) {
    weight = sampled ? 0 : 1;
  }
  LANEWISE_SET_RGB(p, L, LANEWISE_RGB(p, L) + weight * (LANEWISE_RGB(p, beta) * sky.radiance));
}

}  // namespace lanewise::reference
