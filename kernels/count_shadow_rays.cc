#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/count_shadow_rays.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

uint32_t CountShadowRays(const PathState& s, Range range) {
  const DF d;
  uint32_t rays = 0;
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    rays += static_cast<uint32_t>(hn::CountTrue(d, hn::Ne(MaxElement(LoadVec3(s.c_r, s.c_g, s.c_b, i)), hn::Zero(d))));
  }
  return rays;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
HWY_EXPORT(CountShadowRays);
uint32_t count_shadow_rays(const PathState& s, Range range) { return HWY_DYNAMIC_DISPATCH(CountShadowRays)(s, range); }
}  // namespace lanewise
#endif
