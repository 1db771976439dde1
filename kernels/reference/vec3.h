// Scalar twin of kernels/simd-inl.h: a path's fields as GLM vectors, and the frame around a normal.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

#include "core/path_state.h"

// A Vec3<T> from three fields of a path, and back: LANEWISE_VEC3(p, o) is (p.o_x, p.o_y, p.o_z).
#define LANEWISE_VEC3(p, name) \
  ::lanewise::reference::Vec3<std::remove_cvref_t<decltype((p).name##_x)>>((p).name##_x, (p).name##_y, (p).name##_z)
#define LANEWISE_RGB(p, name) \
  ::lanewise::reference::Vec3<std::remove_cvref_t<decltype((p).name##_r)>>((p).name##_r, (p).name##_g, (p).name##_b)
#define LANEWISE_SET_VEC3(p, name, value) \
  do {                                    \
    const auto value_ = (value);          \
    (p).name##_x = value_.x;              \
    (p).name##_y = value_.y;              \
    (p).name##_z = value_.z;              \
  } while (false)
#define LANEWISE_SET_RGB(p, name, value) \
  do {                                   \
    const auto value_ = (value);         \
    (p).name##_r = value_.x;             \
    (p).name##_g = value_.y;             \
    (p).name##_b = value_.z;             \
  } while (false)

namespace lanewise::reference {

template <class T>
using Vec3 = glm::vec<3, T>;

template <class T>
Vec3<T> vec3(const float* a) {
  return {static_cast<T>(a[0]), static_cast<T>(a[1]), static_cast<T>(a[2])};
}

template <class T>
void frame(const Vec3<T>& n, Vec3<T>& b1, Vec3<T>& b2) {
  const T sign = std::copysign(T(1), n.z);
  const T a = T(-1) / (sign + n.z);
  const T b = n.x * n.y * a;
  b1 = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
  b2 = {b, sign + n.y * n.y * a, -n.y};
}

template <class T>
Vec3<T> to_world(const Vec3<T>& local, const Vec3<T>& b1, const Vec3<T>& b2, const Vec3<T>& n) {
  return local.x * b1 + local.y * b2 + local.z * n;
}

template <class T>
Vec3<T> offset_origin(const Vec3<T>& p, const Vec3<T>& n, T err, const Vec3<T>& dir) {
  return p + std::copysign(err, glm::dot(dir, n)) * n;
}

}  // namespace lanewise::reference
