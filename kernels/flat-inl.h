// A vector of rays against a plan's flat lists, all lanes at once: the closest hit, and any hit of a segment.
#if defined(LANEWISE_KERNELS_FLAT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_FLAT_INL_H_
#undef LANEWISE_KERNELS_FLAT_INL_H_
#else
#define LANEWISE_KERNELS_FLAT_INL_H_
#endif

#include "core/plan.h"
#include "kernels/quad-inl.h"
#include "kernels/simd-inl.h"
#include "kernels/sphere-inl.h"
#include "kernels/triangle-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// Nearest so far; u = v / det and v = w / det wait until the end for their divisions. Triangles come last: what has no
// barycentric weights then leaves v = w = 0 and det = 1 as they are.
struct Nearest {
  VF t, v, w, det;
  VI prim;

  HWY_INLINE void Take(MF nearer, VF hit_t, VI hit_prim) {
    t = hn::IfThenElse(nearer, hit_t, t);
    prim = hn::IfThenElse(hn::RebindMask(DI(), nearer), hit_prim, prim);
  }
};

// Whether a hit at t of primitive prim comes before the best one: nearer, or as near with the lower index.
template <class D, class V = hn::Vec<D>, class DInt = hn::RebindToSigned<D>, class VInt = hn::Vec<DInt>>
HWY_INLINE hn::Mask<D> Before(D d, V t, VInt prim, V best_t, VInt best_prim) {
  const auto lower = hn::RebindMask(d, hn::Lt(prim, best_prim));
  return hn::Or(hn::Lt(t, best_t), hn::And(hn::Eq(t, best_t), lower));
}

HWY_INLINE void NearestFlatQuad(const Plan& plan, const Vec3& o, const Vec3& dir, Nearest& best) {
  for (uint32_t i = 0; i < plan.single_quads; ++i) {
    const FlatQuad& quad = plan.flat_quads[i];
    VF t;
    const MF met = TestQuad(quad, o, dir, t);
    const VI prim = hn::Set(DI(), static_cast<int32_t>(quad.prim));
    best.Take(hn::And(met, Before(DF(), t, prim, best.t, best.prim)), t, prim);
  }
}

HWY_INLINE void NearestFlatSlab(const Plan& plan, const Vec3& o, const Vec3& dir, Nearest& best) {
  for (const FlatSlab& slab : plan.flat_slabs) {
    VF t;
    VI prim;
    const MF met = TestSlab(slab, o, dir, t, prim);
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
    best.Take(hit, t, prim);
    best.v = hn::IfThenElse(hit, test.weight[1], best.v);
    best.w = hn::IfThenElse(hit, test.weight[2], best.w);
    best.det = hn::IfThenElse(hit, test.det, best.det);
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

// Whether 0 < depth / det < 1, without the division. The quotient's rounding keeps both limits, so this is what
// intersect's distance would say.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> WithinSegment(D d, V depth, V det) {
  const V sided = hn::Xor(depth, hn::And(det, hn::SignBit(d)));
  return hn::And(hn::Gt(sided, hn::Zero(d)), hn::Lt(sided, hn::Abs(det)));
}

// Which rays o + t dir, between two points of the scene, meet a primitive of the flat lists with 0 < t < 1.
HWY_INLINE MF AnyFlatHit(const Plan& plan, const Vec3& o, const Vec3& dir, MF wanted) {
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
    hit = hn::Or(hit, SphereWithinSegment(d, f, slope, a, inv_a, Splat(sphere.radius)));
  }
  return hit;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
