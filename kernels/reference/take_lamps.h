#pragma once

#include <algorithm>

#include "core/path_state.h"
#include "core/plan.h"
#include "kernels/reference/shading.h"

namespace lanewise::reference {

template <class T>
void take_lamps(const Plan& plan, Path<T>& p) {
  if (p.step.leaving) {
    // as it is
  } else if (!p.step.diffuse) {
    p.lamps = p.lamps == kByItself ? kByItself : kByLightPaths;
  } else {
    p.lamps = p.step.bounce == 0 ? kByItselfYet : std::min<uint32_t>(p.lamps, kByItselfYet);
  }
  if (!plan.prim_normals.empty() && !agrees(p, LANEWISE_VEC3(p, d))) p.lamps = kByItself;
}

}  // namespace lanewise::reference
