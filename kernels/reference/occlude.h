// Scalar twin of kernels/occlude.cc.
#pragma once

#include "core/plan.h"
#include "kernels/reference/intersect.h"

namespace lanewise::reference {

// Whether o + t d meets a primitive with 0 < t < 1; the ends are points of the scene, so that only blocking faces
// count.
template <class T>
bool any_hit(const Plan& plan, const Vec3<T>& o, const Vec3<T>& d) {
  bool blocked = false;
  const auto notice = [&](const Hit<T>& hit) { blocked |= hit.t < 1; };
  hit_flat(plan, plan.blocking_quads, plan.blocking_triangles, o, d, notice);
  if (blocked) return true;
  const Shear<T> shear = make_shear(d);
  const T t_max = 1;
  return walk(plan.triangle_tree, SlabRay<T>(plan.triangle_tree.bounds, o, d), t_max,
              [&](uint32_t block) {
                hit_block(plan.triangle_blocks[block], o, shear, notice);
                return blocked;
              }) ||
         walk(plan.sphere_tree, SlabRay<T>(plan.sphere_tree.bounds, o, d), t_max, [&](uint32_t block) {
           hit_block(plan.sphere_blocks[block], o, d, notice);
           return blocked;
         });
}

template <class T>
void occlude(const Plan& plan, Path<T>& p) {
  const Vec3<T> c = LANEWISE_RGB(p, c), l = LANEWISE_VEC3(p, l);
  if (c == Vec3<T>(0)) return;
  const Vec3<T> o = offset_origin(LANEWISE_VEC3(p, o), LANEWISE_VEC3(p, n), p.err, l);
  if (!any_hit(plan, o, l)) LANEWISE_SET_RGB(p, L, LANEWISE_RGB(p, L) + c);
}

template <class T>
void occlude_connection(const Plan& plan, Path<T>& p) {
  const Vec3<T> c = LANEWISE_RGB(p, c), l = LANEWISE_VEC3(p, l), m = LANEWISE_VEC3(p, m);
  if (c == Vec3<T>(0)) return;
  const Vec3<T> o = offset_origin(LANEWISE_VEC3(p, o), LANEWISE_VEC3(p, n), p.err, l);
  if (any_hit(plan, o, l) || any_hit(plan, o + l, m)) return;
  LANEWISE_SET_RGB(p, L, LANEWISE_RGB(p, L) + c * vec3<T>(plan.connected_spheres[p.via].reflectance));
}

}  // namespace lanewise::reference
