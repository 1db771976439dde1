// From uniform numbers to directions. Scalar twin: kernels/reference/sampling.h.
#if defined(LANEWISE_KERNELS_SAMPLING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_SAMPLING_INL_H_
#undef LANEWISE_KERNELS_SAMPLING_INL_H_
#else
#define LANEWISE_KERNELS_SAMPLING_INL_H_
#endif

#include "kernels/math-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

constexpr float kPi = 3.14159265358979f;
constexpr float kInvPi = 0.318309886183791f;

// u, v in [0, 1) to the unit hemisphere around +z with density z / pi: the polar map, because without the branches and
// the division of the concentric one it costs half. z > 0 always.
HWY_INLINE Vec3 CosineHemisphere(VF u, VF v) {
  VF sin, cos;
  SinCos2Pi(v, sin, cos);
  const VF r = hn::Sqrt(u);
  return {hn::Mul(r, cos), hn::Mul(r, sin), hn::Sqrt(hn::Sub(Splat(1.0f), u))};
}

// u, v in [0, 1) to the unit hemisphere around +z with density 1 / (2 pi). z > 0 always.
HWY_INLINE Vec3 UniformHemisphere(VF u, VF v) {
  VF sin, cos;
  SinCos2Pi(v, sin, cos);
  const VF r = hn::Sqrt(hn::Mul(u, hn::Sub(Splat(2.0f), u)));  // sqrt(1 - z^2) without its cancellation
  return {hn::Mul(r, cos), hn::Mul(r, sin), hn::Sub(Splat(1.0f), u)};
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
