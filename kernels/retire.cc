#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/retire.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// Padding retires to its own slot, past the wave's last: all its lanes write there, and nobody reads it.
void Retire(const Plan&, const PathState& s, Range range) {
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(DF())) {
    const VI slot = hn::BitCast(DI(), hn::Load(DU(), s.slot + i));
    ScatterVec3(LoadVec3(s.L_r, s.L_g, s.L_b, i), s.result_r, s.result_g, s.result_b, slot);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(Retire, retire);
}  // namespace lanewise
#endif
