// Scalar twin of kernels/surface.cc.
#pragma once

#include "core/plan.h"
#include "kernels/reference/vec3.h"

namespace lanewise::reference {

template <class T>
void surface(const Plan& plan, Path<T>& p) {
  const float* entry = &plan.prim_shape[size_t{4} * p.prim];
  const Vec3<T> shape = vec3<T>(entry), d = LANEWISE_VEC3(p, d);
  const Vec3<T> hit = LANEWISE_VEC3(p, o) + p.t * d;
  Vec3<T> n, at, shading;
  if (p.prim < plan.triangles) {
    n = shading = shape;
    at = hit + (T(entry[3]) - glm::dot(n, hit)) * n;
    if (!plan.prim_normals.empty()) {
      const float* corner = &plan.prim_normals[size_t{9} * p.prim];
      const Vec3<T> mixed = (1 - p.u - p.v) * vec3<T>(corner) + p.u * vec3<T>(corner + 3) + p.v * vec3<T>(corner + 6);
      if (glm::dot(mixed, mixed) > T(1e-12)) shading = glm::normalize(mixed);
    }
  } else {
    const Vec3<T> out = hit - shape;
    n = shading = glm::dot(out, out) > 0 ? glm::normalize(out) : -d;
    at = shape + T(entry[3]) * n;
  }
  LANEWISE_SET_VEC3(p, o, at);
  LANEWISE_SET_VEC3(p, n, n);
  LANEWISE_SET_VEC3(p, s, shading);
  p.err = T(plan.prim_err[p.prim]);
}

}  // namespace lanewise::reference
