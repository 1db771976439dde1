// Moeller & Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997, in float, as the textbooks have it: the
// form that the tests of small triangles and of leaks measure ours against.
#pragma once

#include <cmath>

#include "tests/trace_plan.h"

namespace lanewise::test {

// Whether the ray meets the triangle in front of its origin; determinants up to epsilon count as edge-on.
inline bool moeller_trumbore(const Triangle& t, const Ray& ray, float epsilon) {
  const glm::vec3 e1 = t[1] - t[0], e2 = t[2] - t[0], p = glm::cross(ray.d, e2);
  const float det = glm::dot(e1, p);
  if (std::abs(det) <= epsilon) return false;
  const float inverse = 1 / det;
  const glm::vec3 s = ray.o - t[0];
  const float u = inverse * glm::dot(s, p);
  if (u < 0 || u > 1) return false;
  const glm::vec3 q = glm::cross(s, e1);
  const float v = inverse * glm::dot(ray.d, q);
  return v >= 0 && u + v <= 1 && inverse * glm::dot(e2, q) > 0;
}

}  // namespace lanewise::test
