// Scalar twin of kernels/intersect.cc and kernels/closest-inl.h.
#pragma once

#include <limits>

#include "core/plan.h"
#include "kernels/reference/quad.h"
#include "kernels/reference/sphere.h"
#include "kernels/reference/traverse.h"
#include "kernels/reference/triangle.h"
#include "kernels/reference/vec3.h"

namespace lanewise::reference {

template <class T>
struct Hit {
  T t = std::numeric_limits<T>::infinity();
  T u = 0, v = 0;
  uint32_t prim = kNoPrim;

  // Takes what is nearer, and of hits at the same distance the one of the lowest primitive.
  void offer(const Hit& other) {
    if (other.t < t || (other.t == t && other.prim < prim)) *this = other;
  }
};

// Where o + t d, t > 0, meets a triangle, if it does.
template <class T>
Hit<T> hit_triangle(const Vec3<T> (&v)[3], uint32_t prim, const Vec3<T>& o, const Shear<T>& shear) {
  const TriangleTest<T> test = test_triangle<T>({v[0] - o, v[1] - o, v[2] - o}, shear);
  const T t = test.depth / test.det;
  if (!test.inside || !(t > 0) || !(t < std::numeric_limits<T>::infinity())) return {};
  return {t, test.weight.y / test.det, test.weight.z / test.det, prim};
}

template <class T>
Hit<T> hit_sphere(const Vec3<T>& center, T radius, uint32_t prim, const Vec3<T>& o, const Vec3<T>& d) {
  const T t = sphere_root<T>(o - center, d, radius);
  if (!(t < std::numeric_limits<T>::infinity())) return {};
  return {t, 0, 0, prim};
}

template <class T>
Hit<T> hit_quad(const FlatQuad& quad, const Vec3<T>& o, const Vec3<T>& d) {
  const T t = quad_root<T>(quad, o, d);
  if (t == 0) return {};
  return {t, 0, 0, quad.prim};
}

// Calls visit(hit) with what the ray meets in each triangle and sphere of a block.
template <class T, class Visit>
void hit_block(const TriangleBlock& block, const Vec3<T>& o, const Shear<T>& shear, const Visit& visit) {
  for (uint32_t i = 0; i < kLeafWidth; ++i) {
    if (block.prim[i] == kNoPrim) continue;
    Vec3<T> v[3];
    for (int k = 0; k < 3; ++k) v[k] = {block.v[k][0][i], block.v[k][1][i], block.v[k][2][i]};
    visit(hit_triangle<T>(v, block.prim[i], o, shear));
  }
}

template <class T, class Visit>
void hit_block(const SphereBlock& block, const Vec3<T>& o, const Vec3<T>& d, const Visit& visit) {
  for (uint32_t i = 0; i < kLeafWidth; ++i) {
    if (block.prim[i] == kNoPrim) continue;
    visit(hit_sphere<T>({block.center[0][i], block.center[1][i], block.center[2][i]}, block.radius[i], block.prim[i], o,
                        d));
  }
}

// The same for the first `quads` quads, the first `triangles` triangles and all spheres of the flat lists.
template <class T, class Visit>
void hit_flat(const Plan& plan, size_t quads, size_t triangles, const Vec3<T>& o, const Vec3<T>& d,
              const Visit& visit) {
  for (size_t i = 0; i < quads; ++i) visit(hit_quad<T>(plan.flat_quads[i], o, d));
  const Shear<T> shear = make_shear(d);
  for (size_t i = 0; i < triangles; ++i) {
    const FlatTriangle& f = plan.flat_triangles[i];
    visit(hit_triangle<T>({vec3<T>(f.v[0]), vec3<T>(f.v[1]), vec3<T>(f.v[2])}, f.prim, o, shear));
  }
  for (const FlatSphere& f : plan.flat_spheres) visit(hit_sphere<T>(vec3<T>(f.center), T(f.radius), f.prim, o, d));
}

template <class T>
Hit<T> closest_hit(const Plan& plan, const Vec3<T>& o, const Vec3<T>& d) {
  Hit<T> best;
  const auto offer = [&](const Hit<T>& hit) { best.offer(hit); };
  hit_flat(plan, plan.flat_quads.size(), plan.flat_triangles.size(), o, d, offer);
  const Shear<T> shear = make_shear(d);
  walk(plan.triangle_tree, SlabRay<T>(plan.triangle_tree.bounds, o, d), best.t, [&](uint32_t block) {
    hit_block(plan.triangle_blocks[block], o, shear, offer);
    return false;
  });
  walk(plan.sphere_tree, SlabRay<T>(plan.sphere_tree.bounds, o, d), best.t, [&](uint32_t block) {
    hit_block(plan.sphere_blocks[block], o, d, offer);
    return false;
  });
  return best;
}

template <class T>
void intersect(const Plan& plan, Path<T>& p) {
  Hit<T> hit;
  const bool alive = p.beta_r > 0 || p.beta_g > 0 || p.beta_b > 0;
  if (alive) hit = closest_hit(plan, LANEWISE_VEC3(p, o), LANEWISE_VEC3(p, d));
  p.t = hit.t;
  p.u = hit.u;
  p.v = hit.v;
  p.prim = hit.prim;
  const uint32_t missed = alive && !plan.environment.empty() ? kSky : kFinished;
  p.bin = hit.prim == kNoPrim ? missed : plan.prim_bin[hit.prim];
  if (p.step.bounce >= plan.settings.max_depth && p.bin < kSurfaceBins) p.bin = kFinished;
}

}  // namespace lanewise::reference
