#pragma once

#include "kernels/reference/shading.h"

namespace lanewise::reference {

template <class T>
void shade_mirror(const Plan& plan, Path<T>& p) {
  const Vec3<T> d = LANEWISE_VEC3(p, d), normal = LANEWISE_VEC3(p, s);
  const Vec3<T> wi = glm::normalize(d - 2 * glm::dot(d, normal) * normal);
  leave(p, wi, vec3<T>(material_at(plan, p).reflectance), pdf_after_delta(plan, p, glm::dot(d, normal) < 0));
}

}  // namespace lanewise::reference
