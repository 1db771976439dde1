// The closest hit of a vector of rays in all of a plan's primitives: flat lists with all lanes at once, then the trees,
// ray by ray, for those that meet their bounds. A ray's result does not depend on the vector's width, nor on whether a
// primitive is in a list or a tree.
#if defined(LANEWISE_KERNELS_CLOSEST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_CLOSEST_INL_H_
#undef LANEWISE_KERNELS_CLOSEST_INL_H_
#else
#define LANEWISE_KERNELS_CLOSEST_INL_H_
#endif

#include "core/plan.h"
#include "kernels/leaf-inl.h"
#include "kernels/quad-inl.h"
#include "kernels/simd-inl.h"
#include "kernels/sphere-inl.h"
#include "kernels/traverse-inl.h"
#include "kernels/triangle-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

struct Hits {
  VF t, u, v;  // +inf, 0 and 0 for none
  VI prim;     // kNoHit for none
};

// Nearest so far; u = v / det and v = w / det wait until the end for their divisions.
struct Nearest {
  VF t, v, w, det;
  VI prim;

  // A hit without barycentric weights takes the place of the best one where `nearer` says so.
  HWY_INLINE void Take(MF nearer, VF hit_t, VI hit_prim) {
    t = hn::IfThenElse(nearer, hit_t, t);
    v = hn::IfThenZeroElse(nearer, v);
    w = hn::IfThenZeroElse(nearer, w);
    det = hn::IfThenElse(nearer, Splat(1.0f), det);
    prim = hn::IfThenElse(hn::RebindMask(DI(), nearer), hit_prim, prim);
  }
};

// The same in memory, for rays that walk a tree one by one.
struct NearestLanes {
  HWY_ALIGN float t[kLanes], v[kLanes], w[kLanes], det[kLanes];
  HWY_ALIGN int32_t prim[kLanes];

  HWY_INLINE void Store(const Nearest& best) {
    const DF d;
    hn::Store(best.t, d, t);
    hn::Store(best.v, d, v);
    hn::Store(best.w, d, w);
    hn::Store(best.det, d, det);
    hn::Store(best.prim, DI(), prim);
  }
  HWY_INLINE Nearest Load() const {
    const DF d;
    return {hn::Load(d, t), hn::Load(d, v), hn::Load(d, w), hn::Load(d, det), hn::Load(DI(), prim)};
  }
};

// Whether a hit at t of primitive prim comes before the best one: nearer, or as near with the lower index.
template <class D, class V = hn::Vec<D>, class DInt = hn::RebindToSigned<D>, class VInt = hn::Vec<DInt>>
HWY_INLINE hn::Mask<D> Before(D d, V t, VInt prim, V best_t, VInt best_prim) {
  const auto lower = hn::RebindMask(d, hn::Lt(prim, best_prim));
  return hn::Or(hn::Lt(t, best_t), hn::And(hn::Eq(t, best_t), lower));
}

HWY_INLINE void NearestFlatQuad(const Plan& plan, const Vec3& o, const Vec3& dir, Nearest& best) {
  for (const FlatQuad& quad : plan.flat_quads) {
    VF t;
    const MF met = TestQuad(quad, o, dir, t);
    const VI prim = hn::Set(DI(), static_cast<int32_t>(quad.prim));
    best.Take(hn::And(met, Before(DF(), t, prim, best.t, best.prim)), t, prim);
  }
}

HWY_INLINE void NearestFlatTriangle(const Plan& plan, const Vec3& o, const Vec3& dir, MF alive, Nearest& best) {
  const DF d;
  if (plan.flat_triangles.empty()) return;
  const Shear shear = MakeShear(dir);
  for (const FlatTriangle& triangle : plan.flat_triangles) {
    const TriangleTest<DF> test = TestTriangle(triangle, o, shear, alive);
    const VF t = hn::Div(test.depth, test.det);
    const VI prim = hn::Set(DI(), static_cast<int32_t>(triangle.prim));
    const MF hit = hn::And(hn::And(test.inside, hn::Gt(t, hn::Zero(d))), Before(d, t, prim, best.t, best.prim));
    best.t = hn::IfThenElse(hit, t, best.t);
    best.v = hn::IfThenElse(hit, test.weight[1], best.v);
    best.w = hn::IfThenElse(hit, test.weight[2], best.w);
    best.det = hn::IfThenElse(hit, test.det, best.det);
    best.prim = hn::IfThenElse(hn::RebindMask(DI(), hit), prim, best.prim);
  }
}

HWY_INLINE void NearestFlatSphere(const Plan& plan, const Vec3& o, const Vec3& dir, Nearest& best) {
  const DF d;
  const VF a = Dot(dir, dir), inv_a = hn::Div(Splat(1.0f), a);
  const VF slope[3] = {dir.x, dir.y, dir.z};
  for (const FlatSphere& sphere : plan.flat_spheres) {
    const Vec3 to = Sub(o, SplatVec3(sphere.center));
    const VF f[3] = {to.x, to.y, to.z};
    const VF t = SphereRoot(d, f, slope, a, inv_a, Splat(sphere.radius));
    const VI prim = hn::Set(DI(), static_cast<int32_t>(sphere.prim));
    best.Take(Before(d, t, prim, best.t, best.prim), t, prim);
  }
}

inline HWY_NOINLINE void WalkTriangles(const Plan& plan, const SlabRays& slabs, const RayLanes& rays, size_t lane,
                                       NearestLanes& best) {
  const DLeaf d;
  const hn::RebindToSigned<DLeaf> di;
  const TriangleLeaf triangles(plan, rays, lane);
  const auto leaf = [&](size_t b) HWY_ATTR __attribute__((always_inline)) {
    const TriangleBlock& block = triangles.Block(b);
    for (size_t i = 0; i < kLeafWidth; i += hn::Lanes(d)) {
      const TriangleTest<DLeaf> test = triangles.Test(block, i);
      const VLeaf t = hn::Div(test.depth, test.det);
      const auto prim = hn::Load(di, TriangleLeaf::Prims(block) + i);
      const auto hit = hn::And(
          hn::And(test.inside, TriangleLeaf::Used(block, i)),
          hn::And(hn::Gt(t, hn::Zero(d)), Before(d, t, prim, hn::Set(d, best.t[lane]), hn::Set(di, best.prim[lane]))));
      if (hn::AllFalse(d, hit)) continue;
      HWY_ALIGN float ts[kLeafWidth], vs[kLeafWidth], ws[kLeafWidth], dets[kLeafWidth];
      hn::Store(t, d, ts);
      hn::Store(test.weight[1], d, vs);
      hn::Store(test.weight[2], d, ws);
      hn::Store(test.det, d, dets);
      for (uint32_t hits = MaskBits(d, hit); hits != 0; hits &= hits - 1) {
        const size_t k = static_cast<size_t>(std::countr_zero(hits));
        const int32_t p = static_cast<int32_t>(block.prim[i + k]);
        if (ts[k] > best.t[lane] || (ts[k] == best.t[lane] && p > best.prim[lane])) continue;
        best.t[lane] = ts[k];
        best.v[lane] = vs[k];
        best.w[lane] = ws[k];
        best.det[lane] = dets[k];
        best.prim[lane] = p;
      }
    }
  };
  WalkNearestFirst(plan.triangle_tree, slabs, lane, best.t[lane], leaf);
}

inline HWY_NOINLINE void WalkSpheres(const Plan& plan, const SlabRays& slabs, const RayLanes& rays, size_t lane,
                                     NearestLanes& best) {
  const DLeaf d;
  const SphereLeaf spheres(plan, rays, lane);
  const auto leaf = [&](size_t b) HWY_ATTR __attribute__((always_inline)) {
    const SphereBlock& block = spheres.Block(b);
    for (size_t i = 0; i < kLeafWidth; i += hn::Lanes(d)) {
      HWY_ALIGN float ts[kLeafWidth];
      hn::Store(spheres.Test(block, i), d, ts);
      for (size_t k = 0; k < hn::Lanes(d); ++k) {
        const int32_t p = static_cast<int32_t>(block.prim[i + k]);
        if (!(ts[k] < best.t[lane] || (ts[k] == best.t[lane] && p < best.prim[lane]))) continue;
        best.t[lane] = ts[k];
        best.v[lane] = best.w[lane] = 0;
        best.det[lane] = 1;
        best.prim[lane] = p;
      }
    }
  };
  WalkNearestFirst(plan.sphere_tree, slabs, lane, best.t[lane], leaf);
}

// The trees, for the rays that meet their bounds nearer than the best hit so far.
HWY_INLINE void NearestInTrees(const Plan& plan, const Vec3& o, const Vec3& dir, MF alive, Nearest& best) {
  const DF d;
  RayLanes rays;
  rays.Store(o, dir, MakeShear(dir));
  NearestLanes lanes;
  lanes.Store(best);
  SlabRays slabs;
  const auto enter = [&](const Bvh& tree, auto walk) HWY_ATTR {
    if (tree.nodes.empty()) return;
    HWY_ALIGN float entering[kLanes];
    const MF enters = hn::And(alive, EnterBounds(tree.bounds, o, dir, hn::Load(d, lanes.t), slabs));
    hn::Store(hn::IfThenElseZero(enters, Splat(1.0f)), d, entering);
    for (size_t lane = 0; lane < hn::Lanes(d); ++lane) {
      if (entering[lane] != 0) walk(plan, slabs, rays, lane, lanes);
    }
  };
  enter(plan.triangle_tree, WalkTriangles);
  enter(plan.sphere_tree, WalkSpheres);
  best = lanes.Load();
}

// Rays o + t dir, t > 0, dir of any length but 0. Lanes out of `alive` hit nothing.
HWY_INLINE Hits ClosestHit(const Plan& plan, const Vec3& o, const Vec3& dir, MF alive) {
  const DF d;
  const VF zero = hn::Zero(d);
  // A dead lane's limit of 0 lets no hit pass.
  Nearest best{hn::IfThenElseZero(alive, Splat(kInfinity)), zero, zero, Splat(1.0f), hn::Set(DI(), kNoHit)};
  NearestFlatQuad(plan, o, dir, best);
  NearestFlatTriangle(plan, o, dir, alive, best);
  NearestFlatSphere(plan, o, dir, best);
  if (!plan.triangle_tree.nodes.empty() || !plan.sphere_tree.nodes.empty()) NearestInTrees(plan, o, dir, alive, best);
  const MF none = hn::RebindMask(d, hn::Eq(best.prim, hn::Set(DI(), kNoHit)));
  return {hn::IfThenElse(none, Splat(kInfinity), best.t), hn::Div(best.v, best.det), hn::Div(best.w, best.det),
          best.prim};
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
