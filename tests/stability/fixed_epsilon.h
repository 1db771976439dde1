// The naive form of a ray's distance to the surface that it leaves: a constant, in scene units.
#pragma once

#include "core/plan.h"

namespace lanewise::test {

constexpr float kFixedEpsilon = 1e-4f;

inline Plan with_fixed_epsilon(Plan plan) {
  for (float& err : plan.prim_err) err = kFixedEpsilon;
  for (PlanLight& light : plan.lights) light.err = kFixedEpsilon;
  return plan;
}

}  // namespace lanewise::test
