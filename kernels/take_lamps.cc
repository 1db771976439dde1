#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/take_lamps.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/shading-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

void TakeLamps(const Plan& plan, const PathState& s, Range range) {
  const DU d;
  const VU itself = hn::Set(d, kByItself), yet = hn::Set(d, kByItselfYet), others = hn::Set(d, kByLightPaths);
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    VU lamps = hn::Load(d, s.lamps + i);
    if (s.step.leaving) {
      // as it is
    } else if (!s.step.diffuse) {
      lamps = hn::IfThenElse(hn::Eq(lamps, itself), itself, others);
    } else {
      lamps = s.step.bounce == 0 ? yet : hn::Min(lamps, yet);
    }
    if (!plan.prim_normals.empty()) {
      const MF agrees = Agrees(s, i, LoadVec3(s.d_x, s.d_y, s.d_z, i));
      lamps = hn::IfThenElse(hn::RebindMask(d, agrees), lamps, itself);
    }
    hn::Store(lamps, d, s.lamps + i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(TakeLamps, take_lamps);
}  // namespace lanewise
#endif
