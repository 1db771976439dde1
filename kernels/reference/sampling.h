// Scalar twin of kernels/sampling-inl.h.
#pragma once

#include <cmath>
#include <numbers>

#include "kernels/reference/vec3.h"

namespace lanewise::reference {

template <class T>
Vec3<T> cosine_hemisphere(T u, T v) {
  const T phi = 2 * std::numbers::pi_v<T> * v, r = std::sqrt(u);
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u)};
}

template <class T>
Vec3<T> uniform_hemisphere(T u, T v) {
  const T phi = 2 * std::numbers::pi_v<T> * v, r = std::sqrt(u * (2 - u));
  return {r * std::cos(phi), r * std::sin(phi), 1 - u};
}

}  // namespace lanewise::reference
