#pragma once

#include "kernels/reference/shading.h"

namespace lanewise::reference {

template <class T>
void shade_mirror(const Plan& plan, Path<T>& p) {
  const Vec3<T> d = LANEWISE_VEC3(p, d), normal = LANEWISE_VEC3(p, s);
  const Vec3<T> wi = glm::normalize(d - 2 * glm::dot(d, normal) * normal);
  leave(p, wi, vec3<T>(material_at(plan, p).reflectance), T(0));
}

}  // namespace lanewise::reference
