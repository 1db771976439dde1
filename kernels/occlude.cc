#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/occlude.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/leaf-inl.h"
#include "kernels/quad-inl.h"
#include "kernels/simd-inl.h"
#include "kernels/sphere-inl.h"
#include "kernels/traverse-inl.h"
#include "kernels/triangle-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// Whether 0 < depth / det < 1, without the division. The quotient's rounding keeps both limits, so this is what
// intersect's distance would say.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> WithinSegment(D d, V depth, V det) {
  const V sided = hn::Xor(depth, hn::And(det, hn::SignBit(d)));
  return hn::And(hn::Gt(sided, hn::Zero(d)), hn::Lt(sided, hn::Abs(det)));
}

HWY_NOINLINE bool WalkTrianglesAny(const Plan& plan, const SlabRays& slabs, const RayLanes& rays, size_t lane) {
  const DLeaf d;
  const TriangleLeaf triangles(plan, rays, lane);
  const auto leaf = [&](size_t b) HWY_ATTR __attribute__((always_inline)) {
    const TriangleBlock& block = triangles.Block(b);
    for (size_t i = 0; i < kLeafWidth; i += hn::Lanes(d)) {
      const TriangleTest<DLeaf> test = triangles.Test(block, i);
      const auto hit =
          hn::And(hn::And(test.inside, TriangleLeaf::Used(block, i)), WithinSegment(d, test.depth, test.det));
      if (!hn::AllFalse(d, hit)) return true;
    }
    return false;
  };
  return WalkUntil(plan.triangle_tree, slabs, lane, 1.0f, leaf);
}

HWY_NOINLINE bool WalkSpheresAny(const Plan& plan, const SlabRays& slabs, const RayLanes& rays, size_t lane) {
  const DLeaf d;
  const SphereLeaf spheres(plan, rays, lane);
  const auto leaf = [&](size_t b) HWY_ATTR __attribute__((always_inline)) {
    const SphereBlock& block = spheres.Block(b);
    for (size_t i = 0; i < kLeafWidth; i += hn::Lanes(d)) {
      if (!hn::AllFalse(d, hn::Lt(spheres.Test(block, i), hn::Set(d, 1.0f)))) return true;
    }
    return false;
  };
  return WalkUntil(plan.sphere_tree, slabs, lane, 1.0f, leaf);
}

// Which rays o + t dir, between two points of the scene, meet a primitive with 0 < t < 1. Lanes out of `wanted` meet
// none.
HWY_INLINE MF AnyHit(const Plan& plan, const Vec3& o, const Vec3& dir, MF wanted) {
  const DF d;
  const VF one = Splat(1.0f);
  MF hit = hn::Lt(one, hn::Zero(d));
  for (uint32_t i = 0; i < plan.blocking_quads; ++i) {
    VF t;
    const MF met = TestQuad(plan.flat_quads[i], o, dir, t);
    hit = hn::Or(hit, hn::And(met, hn::Lt(t, one)));
  }
  if (plan.blocking_triangles > 0) {
    const Shear shear = MakeShear(dir);
    for (uint32_t i = 0; i < plan.blocking_triangles; ++i) {
      const TriangleTest<DF> test = TestTriangle(plan.flat_triangles[i], o, shear, wanted);
      hit = hn::Or(hit, hn::And(test.inside, WithinSegment(d, test.depth, test.det)));
    }
  }
  const VF a = Dot(dir, dir), inv_a = hn::Div(one, a);
  const VF slope[3] = {dir.x, dir.y, dir.z};
  for (const FlatSphere& sphere : plan.flat_spheres) {
    const Vec3 to = Sub(o, SplatVec3(sphere.center));
    const VF f[3] = {to.x, to.y, to.z};
    hit = hn::Or(hit, hn::Lt(SphereRoot(d, f, slope, a, inv_a, Splat(sphere.radius)), one));
  }
  if (plan.triangle_tree.nodes.empty() && plan.sphere_tree.nodes.empty()) return hn::And(wanted, hit);

  RayLanes rays;
  rays.Store(o, dir, MakeShear(dir));
  SlabRays slabs;
  HWY_ALIGN float blocked[kLanes];
  hn::Store(hn::IfThenElseZero(hit, one), d, blocked);
  const auto enter = [&](const Bvh& tree, auto walk) HWY_ATTR {
    if (tree.nodes.empty()) return;
    HWY_ALIGN float entering[kLanes];
    hn::Store(hn::IfThenElseZero(hn::And(wanted, EnterBounds(tree.bounds, o, dir, one, slabs)), one), d, entering);
    for (size_t lane = 0; lane < hn::Lanes(d); ++lane) {
      if (entering[lane] != 0 && blocked[lane] == 0 && walk(plan, slabs, rays, lane)) blocked[lane] = 1;
    }
  };
  enter(plan.triangle_tree, WalkTrianglesAny);
  enter(plan.sphere_tree, WalkSpheresAny);
  return hn::And(wanted, hn::Gt(hn::Load(d, blocked), hn::Zero(d)));
}

void Occlude(const Plan& plan, const PathState& s, Range range) {
  const DF d;
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const Vec3 c = LoadVec3(s.c_r, s.c_g, s.c_b, i);
    const MF wanted = hn::Gt(MaxElement({hn::Abs(c.x), hn::Abs(c.y), hn::Abs(c.z)}), hn::Zero(d));
    if (hn::AllFalse(d, wanted)) continue;
    const Vec3 l = LoadVec3(s.l_x, s.l_y, s.l_z, i), n = LoadVec3(s.n_x, s.n_y, s.n_z, i);
    const Vec3 o = OffsetOrigin(LoadVec3(s.o_x, s.o_y, s.o_z, i), n, hn::Load(d, s.err + i), l);
    const MF lit = hn::Not(AnyHit(plan, o, l, wanted));
    StoreVec3(Add(LoadVec3(s.L_r, s.L_g, s.L_b, i), IfThenElseZero(lit, c)), s.L_r, s.L_g, s.L_b, i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(Occlude, occlude);
}  // namespace lanewise
#endif
