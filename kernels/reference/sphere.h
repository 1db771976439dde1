// Scalar twin of kernels/sphere-inl.h.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/reference/vec3.h"

namespace lanewise::reference {

// The nearest root above 0 in units of d, +inf for none. f: origin - center.
template <class T>
T sphere_root(const Vec3<T>& f, const Vec3<T>& d, T radius) {
  const T a = glm::dot(d, d), b = -glm::dot(f, d), r2 = radius * radius;
  const Vec3<T> foot = f + b / a * d;
  const T c = glm::dot(f, f) - r2;
  T depth2 = r2 - glm::dot(foot, foot);
  if (c < 0) depth2 = std::max(depth2, T(0));
  if (!(depth2 >= 0)) return std::numeric_limits<T>::infinity();
  const T q = b + std::copysign(std::sqrt(a * depth2), b);
  const T t0 = c / q, t1 = q / a;
  const T near = std::min(t0, t1), far = std::max(t0, t1);
  const T root = near > 0 ? near : far;
  return root > 0 ? root : std::numeric_limits<T>::infinity();
}

}  // namespace lanewise::reference
