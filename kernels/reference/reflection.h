// Scalar twin of kernels/reflection-inl.h.
//
// A sphere of radius R about the origin, x and y outside at distances a and b, with the angle gamma between them. The normal
// n where y is seen from x lies in their plane and halves the angle between the ways to x and to y. With delta its angle from
// the bisector of x and y, towards the nearer of them, that is
//   sin delta cos delta = q cos delta + p sin delta,
//   p = R/2 (1/a + 1/b) cos(gamma/2),  q = R/2 |1/a - 1/b| sin(gamma/2),
// and with t = tan(delta/2)
//   f(t) = q t^4 - 2 (1 + p) t^3 + 2 (1 - p) t - q = 0.
// At delta = 0 f is not above 0, and it is concave until past its first root. That root is the reflection if x and y are both
// above the sphere's tangent plane there, and if not, there is none: at incidence i, gamma = 2 i - asin(R sin i / a) -
// asin(R sin i / b) grows with i, so that two cannot be.
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/reference/vec3.h"

namespace lanewise::reference {

template <class T>
struct SphereReflection {
  bool exists;
  Vec3<T> n;     // unit normal of the sphere at the point of reflection
  Vec3<T> to_y;  // from there to y
  T distance;    // its length
  T cosine;      // of incidence
  T spread;      // area across the ray at y per steradian at x
};

// Newton's method from 0, which cannot step over the first root of a concave function.
template <class T>
T half_tilt(T p, T q) {
  T t = 0;
  for (int step = 0; step < 60; ++step) {
    const T f = q * t * t * t * t - 2 * (1 + p) * t * t * t + 2 * (1 - p) * t - q;
    const T slope = 4 * q * t * t * t - 6 * (1 + p) * t * t + 2 * (1 - p);
    if (!(slope > 0) || !(f < 0)) break;
    t -= f / slope;
  }
  return t;
}

// x and y from the centre of the sphere.
template <class T>
SphereReflection<T> reflect_in_sphere(const Vec3<T>& x, const Vec3<T>& y, T radius) {
  const T a = glm::length(x), b = glm::length(y), tiny = T(1e-18);
  const Vec3<T> sum = x / a + y / b, difference = y / b - x / a;
  const T sum_length = std::max(glm::length(sum), tiny), difference_length = std::max(glm::length(difference), tiny);
  const T closer = 1 / b - 1 / a;
  const T p = radius / 4 * (1 / a + 1 / b) * sum_length, q = radius / 4 * std::abs(closer) * difference_length;
  const T t = half_tilt(p, q), delta_cos = (1 - t * t) / (1 + t * t), delta_sin = 2 * t / (1 + t * t);

  SphereReflection<T> out;
  out.n = delta_cos / sum_length * sum + std::copysign(delta_sin / difference_length, closer) * difference;
  const Vec3<T> to_x = x - radius * out.n;
  out.to_y = y - radius * out.n;
  const T x_height = glm::dot(to_x, out.n), y_height = glm::dot(out.to_y, out.n);
  out.exists = x_height > 0 && y_height > 0;
  const T x_distance = glm::length(to_x);
  out.distance = glm::length(out.to_y);
  const T whole = x_distance + out.distance;
  out.cosine = std::min((x_height + y_height) / whole, T(1));
  // A sphere is a mirror of focal length R cos / 2 in the plane of incidence, of R / (2 cos) across it (Coddington): behind it
  // the two radii of a wavefront from x are those of a point each.
  const T curved = 2 * x_distance * out.distance / radius;
  out.spread = (whole + curved * out.cosine) * (whole + curved / out.cosine);
  return out;
}

}  // namespace lanewise::reference
