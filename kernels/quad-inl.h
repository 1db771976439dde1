// One parallelogram against a vector of rays: where the ray meets its plane, and two linear forms there. See FlatQuad
// for what its margins promise. Scalar twin: kernels/reference/quad.h.
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

// a.p + c with uniform a and c.
HWY_INLINE VF LinearForm(const float* a, float c, const Vec3& p) {
  return hn::MulAdd(Splat(a[0]), p.x, hn::MulAdd(Splat(a[1]), p.y, hn::MulAdd(Splat(a[2]), p.z, Splat(c))));
}

// Sets t to the distance of the quad's plane along o + t dir; returns whether it is met on the quad with t > 0. A ray
// within the plane divides by 0, and then the comparisons fail.
HWY_INLINE MF TestQuad(const FlatQuad& quad, const Vec3& o, const Vec3& dir, VF& t) {
  const Vec3 n = SplatVec3(quad.n);
  t = hn::Div(hn::Neg(LinearForm(quad.n, -quad.distance, o)), Dot(n, dir));
  const Vec3 q = MulAdd(t, dir, o);
  const MF a = hn::Le(hn::Abs(LinearForm(quad.a, quad.a_0, q)), Splat(1.0f + quad.a_margin));
  const MF b = hn::Le(hn::Abs(LinearForm(quad.b, quad.b_0, q)), Splat(1.0f + quad.b_margin));
  return hn::And(hn::And(a, b), hn::Gt(t, hn::Zero(DF())));
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
