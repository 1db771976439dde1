// One parallelogram, or two opposite ones, against a vector of rays: where the ray meets its plane, and two linear forms
// there. See FlatQuad for what its margins promise. Scalar twin: kernels/reference/quad.h.
#if defined(LANEWISE_KERNELS_QUAD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_QUAD_INL_H_
#undef LANEWISE_KERNELS_QUAD_INL_H_
#else
#define LANEWISE_KERNELS_QUAD_INL_H_
#endif

#include "core/plan.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// a.p + c with uniform a.
HWY_INLINE VF LinearForm(const float* a, VF c, const Vec3& p) {
  return hn::MulAdd(Splat(a[0]), p.x, hn::MulAdd(Splat(a[1]), p.y, hn::MulAdd(Splat(a[2]), p.z, c)));
}

// Whether the point at t of the ray, on the plane of a FlatQuad or FlatSlab, is on the face and ahead.
template <class Face>
HWY_INLINE MF OnFace(const Face& face, const Vec3& o, const Vec3& dir, VF t) {
  const Vec3 q = MulAdd(t, dir, o);
  const MF a = hn::Le(hn::Abs(LinearForm(face.a, Splat(face.a_0), q)), Splat(1.0f + face.a_margin));
  const MF b = hn::Le(hn::Abs(LinearForm(face.b, Splat(face.b_0), q)), Splat(1.0f + face.b_margin));
  return hn::And(hn::And(a, b), hn::Gt(t, hn::Zero(DF())));
}

// Sets t to the distance of the quad's plane along o + t dir; returns whether it is met on the quad with t > 0. A ray
// within the plane divides by 0, and then the comparisons fail.
HWY_INLINE MF TestQuad(const FlatQuad& quad, const Vec3& o, const Vec3& dir, VF& t) {
  t = hn::Div(hn::Neg(LinearForm(quad.n, Splat(-quad.distance), o)), Dot(SplatVec3(quad.n), dir));
  return OnFace(quad, o, dir, t);
}

// The same for the face of the slab that the ray travels towards, and which primitive that is.
HWY_INLINE MF TestSlab(const FlatSlab& slab, const Vec3& o, const Vec3& dir, VF& t, VI& prim) {
  const DI di;
  const VF slope = Dot(SplatVec3(slab.n), dir);
  const MF up = hn::Gt(slope, hn::Zero(DF()));
  const VF distance = hn::IfThenElse(up, Splat(-slab.distance[1]), Splat(-slab.distance[0]));
  t = hn::Div(hn::Neg(LinearForm(slab.n, distance, o)), slope);
  prim = hn::IfThenElse(hn::RebindMask(di, up), hn::Set(di, static_cast<int32_t>(slab.prim[1])),
                        hn::Set(di, static_cast<int32_t>(slab.prim[0])));
  return OnFace(slab, o, dir, t);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
