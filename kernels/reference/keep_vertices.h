// Scalar twin of kernels/keep_vertices.cc.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/path_reuse.h"
#include "kernels/reference/vec3.h"

namespace lanewise::reference {

// What is kept of a path: KeptVertices, one slot.
template <class T>
struct KeptPath {
#define LANEWISE_MEMBER(name, meaning) T name{};
  LANEWISE_KEPT_FIELDS(LANEWISE_MEMBER)
#undef LANEWISE_MEMBER
};

// The surface's normal on the side that dir points to.
template <class T>
Vec3<T> normal_towards(const Path<T>& p, const Vec3<T>& dir) {
  const Vec3<T> n = LANEWISE_VEC3(p, n);
  return std::copysign(T(1), glm::dot(n, dir)) * n;
}

template <class T>
bool is_flat(const Path<T>& p) {
  const Vec3<T> s = LANEWISE_VEC3(p, s), apart = normal_towards(p, s) - s;
  return glm::dot(apart, apart) <= T(kFlatness) * T(kFlatness);
}

template <class T>
void keep_first(const Path<T>& p, KeptPath<T>& kept) {
  if (kept.bounce != 0) return;
  kept.bounce = -1;
  if (!is_flat(p) || LANEWISE_RGB(p, beta) == Vec3<T>(0)) return;
  kept.bounce = T(p.step.bounce + 1);
  LANEWISE_SET_VEC3(kept, x, LANEWISE_VEC3(p, o));
  LANEWISE_SET_VEC3(kept, n, normal_towards(p, LANEWISE_VEC3(p, d)));
  LANEWISE_SET_RGB(kept, f, LANEWISE_RGB(p, beta));
}

template <class T>
void keep_second(Path<T>& p, KeptPath<T>& kept) {
  const Vec3<T> beta = LANEWISE_RGB(p, beta);
  const T most = std::max({beta.x, beta.y, beta.z});
  if (kept.bounce != T(p.step.bounce) || !is_flat(p) || !(most > T(kLeastShared))) return;
  const Vec3<T> n = normal_towards(p, -LANEWISE_VEC3(p, d));
  LANEWISE_SET_VEC3(kept, y, LANEWISE_VEC3(p, o) + p.err * n);
  LANEWISE_SET_VEC3(kept, m, n);
  LANEWISE_SET_RGB(kept, L, LANEWISE_RGB(p, L));
  kept.gain = 1 / most;
  LANEWISE_SET_RGB(p, L, Vec3<T>(0));
  LANEWISE_SET_RGB(p, beta, Vec3<T>(most));
}

}  // namespace lanewise::reference
