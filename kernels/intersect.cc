#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/intersect.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/closest-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

void Intersect(const Plan& plan, const PathState& s, Range range) {
  const DF d;
  const DU du;
  ClosestHits(plan, {s.t, s.u, s.v, s.prim}, range.begin, range.end, [&](size_t i, Vec3& o, Vec3& dir) HWY_ATTR {
    o = LoadVec3(s.o_x, s.o_y, s.o_z, i);
    dir = LoadVec3(s.d_x, s.d_y, s.d_z, i);
    return hn::Gt(MaxElement(LoadVec3(s.beta_r, s.beta_g, s.beta_b, i)), hn::Zero(d));
  });
  const VU emitter = hn::Set(du, uint32_t{kEmitter}), finished = hn::Set(du, uint32_t{kFinished});
  const bool last = s.step.bounce >= plan.settings.max_depth;  // nothing scatters any more
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const VU prim = hn::Load(du, s.prim + i);
    // Missing rays look up primitive 0, and then do not use what they find.
    const auto none = hn::Eq(prim, hn::Set(du, kNoPrim));
    VU bin = hn::GatherIndex(du, plan.prim_bin.data(), hn::BitCast(DI(), hn::IfThenZeroElse(none, prim)));
    if (last) bin = hn::IfThenElse(hn::Eq(bin, emitter), emitter, finished);
    VU missed = finished;
    if (!plan.environment.empty()) {
      const VF beta = MaxElement(LoadVec3(s.beta_r, s.beta_g, s.beta_b, i));
      missed = hn::IfThenElse(hn::RebindMask(du, hn::Gt(beta, hn::Zero(d))), hn::Set(du, uint32_t{kSky}), finished);
    }
    hn::Store(hn::IfThenElse(none, missed, bin), du, s.bin + i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(Intersect, intersect);
}  // namespace lanewise
#endif
