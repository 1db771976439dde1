// Scalar twin of kernels/quad-inl.h.
#pragma once

#include <cmath>

#include "core/plan.h"
#include "kernels/reference/vec3.h"

namespace lanewise::reference {

// Where o + t d meets the quad with t > 0; 0 if it does not.
template <class T>
T quad_root(const FlatQuad& quad, const Vec3<T>& o, const Vec3<T>& d) {
  const Vec3<T> n = vec3<T>(quad.n);
  const T t = (T(quad.distance) - glm::dot(n, o)) / glm::dot(n, d);
  const Vec3<T> q = o + t * d;
  const bool on_a = std::abs(glm::dot(vec3<T>(quad.a), q) + T(quad.a_0)) <= 1 + T(quad.a_margin);
  const bool on_b = std::abs(glm::dot(vec3<T>(quad.b), q) + T(quad.b_0)) <= 1 + T(quad.b_margin);
  return on_a && on_b && t > 0 ? t : T(0);
}

}  // namespace lanewise::reference
