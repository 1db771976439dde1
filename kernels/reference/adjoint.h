#pragma once

#include <cmath>

#include "core/plan.h"
#include "kernels/reference/shading.h"

namespace lanewise::reference {

template <class T>
void adjoint(const Plan& /*plan*/, Path<T>& p) {
  const T shading = std::abs(glm::dot(LANEWISE_VEC3(p, d), LANEWISE_VEC3(p, s)));
  const T geometric = std::abs(glm::dot(LANEWISE_VEC3(p, d), LANEWISE_VEC3(p, n)));
  const T above = p.step.leaving ? geometric : shading, below = p.step.leaving ? shading : geometric;
  LANEWISE_SET_RGB(p, beta,
                   (agrees(p, LANEWISE_VEC3(p, d)) && below > 0 ? above / below : T(0)) * LANEWISE_RGB(p, beta));
}

}  // namespace lanewise::reference
