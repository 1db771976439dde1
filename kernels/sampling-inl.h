// From uniform numbers to directions. Scalar twin: kernels/reference/sampling.h.
#if defined(LANEWISE_KERNELS_SAMPLING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_SAMPLING_INL_H_
#undef LANEWISE_KERNELS_SAMPLING_INL_H_
#else
#define LANEWISE_KERNELS_SAMPLING_INL_H_
#endif

#include <bit>

#include "kernels/math-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

constexpr float kPi = 3.14159265358979f;
constexpr float kInvPi = 0.318309886183791f;

// The first i < n for which cdf[first + stride i] exceeds u, by a search that takes the same steps in all lanes. The last does.
HWY_INLINE VI FindInterval(const float* cdf, VI first, int32_t stride, uint32_t n, VF u) {
  const DI d;
  const VI last = hn::Set(d, static_cast<int32_t>(n) - 1);
  VI found = hn::Zero(d);
  for (uint32_t step = std::bit_floor(n - 1); step > 0; step >>= 1) {
    const VI probe = hn::Min(hn::Add(found, hn::Set(d, static_cast<int32_t>(step))), last);
    const VI before = hn::Add(first, hn::Mul(hn::Sub(probe, hn::Set(d, 1)), hn::Set(d, stride)));
    const VF below = hn::GatherIndex(DF(), cdf, before);
    found = hn::IfThenElse(hn::RebindMask(d, hn::Ge(u, below)), probe, found);
  }
  return found;
}

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
