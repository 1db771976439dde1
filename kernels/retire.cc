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
  const DF d;
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const VI slot = hn::BitCast(DI(), hn::Load(DU(), s.slot + i));
    hn::ScatterIndex(hn::Load(d, s.L_r + i), d, s.result_r, slot);
    hn::ScatterIndex(hn::Load(d, s.L_g + i), d, s.result_g, slot);
    hn::ScatterIndex(hn::Load(d, s.L_b + i), d, s.result_b, slot);
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
