// The naive forms of a ray's distance to the surface that it leaves: a constant, in scene units, or none.
#pragma once

#include "core/plan.h"

namespace lanewise::test {

constexpr float kFixedEpsilon = 1e-4f;

inline Plan with_fixed_epsilon(Plan plan, float epsilon = kFixedEpsilon) {
  for (float& err : plan.prim_err) err = epsilon;
  for (PlanLight& light : plan.lights) light.err = epsilon;
  return plan;
}

}  // namespace lanewise::test
