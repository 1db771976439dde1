// Scalar twin of kernels/triangle-inl.h.
#pragma once

#include <algorithm>
#include <utility>

#include "kernels/reference/vec3.h"

namespace lanewise::reference {

template <class T>
struct Shear {
  int major;  // the axis that changes places with z
  T s_x, s_y, s_z;
};

template <class T>
Shear<T> make_shear(Vec3<T> d) {
  const Vec3<T> size = glm::abs(d);
  const int major = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  std::swap(d[major], d.z);
  return {major, d.x / d.z, d.y / d.z, 1 / d.z};
}

template <class T>
struct TriangleTest {
  Vec3<T> weight;  // over det: barycentric
  T det, depth;    // depth / det: distance in units of the direction
  bool inside;
};

// v: the vertices relative to the ray's origin.
template <class T>
TriangleTest<T> test_triangle(const Vec3<T> (&v)[3], const Shear<T>& shear) {
  T x[3], y[3], z[3];
  for (int k = 0; k < 3; ++k) {
    Vec3<T> p = v[k];
    std::swap(p[shear.major], p.z);
    x[k] = p.x - shear.s_x * p.z;
    y[k] = p.y - shear.s_y * p.z;
    z[k] = p.z;
  }
  Vec3<T> w{x[2] * y[1] - y[2] * x[1], x[0] * y[2] - y[0] * x[2], x[1] * y[0] - y[1] * x[0]};
  if (w.x == 0 || w.y == 0 || w.z == 0) {
    // Exact for float.
    for (int k = 0; k < 3; ++k) {
      const int p = (k + 1) % 3, q = (k + 2) % 3;
      w[k] = static_cast<T>(double{x[q]} * double{y[p]} - double{y[q]} * double{x[p]});
    }
  }
  const T least = std::min({w.x, w.y, w.z}), most = std::max({w.x, w.y, w.z});
  const T depth = shear.s_z * (w.x * z[0] + w.y * z[1] + w.z * z[2]);
  return {w, w.x + w.y + w.z, depth, least >= 0 || most <= 0};
}

}  // namespace lanewise::reference
