// Hits that no rounding can talk away: what the tests of missed hits aim for.
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/reference/triangle.h"
#include "tests/trace_plan.h"

namespace lanewise::test {

// Whether the ray, as it is in floats, meets the triangle with all barycentric weights above the margin and at more than 6
// degrees, by double arithmetic.
inline bool clear_hit(const Triangle& t, const Ray& ray, double margin) {
  const glm::dvec3 from(ray.o), d(ray.d), v0(t[0]), v1(t[1]), v2(t[2]);
  const auto hit = reference::test_triangle<double>({v0 - from, v1 - from, v2 - from}, reference::make_shear(d));
  const glm::dvec3 w = hit.weight / hit.det, n = glm::normalize(glm::cross(v1 - v0, v2 - v0));
  return hit.inside && hit.depth / hit.det > 0 && std::min({w.x, w.y, w.z}) > margin &&
         std::abs(glm::dot(n, glm::normalize(d))) > 0.1;
}

}  // namespace lanewise::test
