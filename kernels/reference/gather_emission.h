// Scalar twin of kernels/gather_emission.cc.
#pragma once

#include "core/plan.h"
#include "kernels/reference/environment_map.h"
#include "kernels/reference/intersect.h"

namespace lanewise::reference {

template <class T>
void gather_emission(const Plan& plan, Path<T>& p) {
  const Vec3<T> c = LANEWISE_RGB(p, c), l = LANEWISE_VEC3(p, l);
  if (c == Vec3<T>(0)) return;
  const Vec3<T> o = offset_origin(LANEWISE_VEC3(p, o), LANEWISE_VEC3(p, n), p.err, l);
  const Hit<T> hit = closest_hit(plan, o, l);
  if (hit.prim == kNoPrim && !plan.environment.empty()) {
    LANEWISE_SET_RGB(p, L, LANEWISE_RGB(p, L) + c * sky_along(plan.environment, l).radiance);
  }
  if (hit.prim == kNoPrim || plan.prim_bin[hit.prim] != kEmitter) return;
  Vec3<T> front = vec3<T>(&plan.prim_shape[size_t{4} * hit.prim]);
  if (hit.prim >= plan.triangles) front = o + hit.t * l - front;
  if (!(glm::dot(front, l) < 0)) return;
  const Vec3<T> radiance = vec3<T>(&plan.light_table[size_t{4} * plan.prim_light[hit.prim]]);
  LANEWISE_SET_RGB(p, L, LANEWISE_RGB(p, L) + c * radiance);
}

}  // namespace lanewise::reference
