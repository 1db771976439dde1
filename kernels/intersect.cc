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
  const VU emitter = hn::Set(du, uint32_t{kEmitter}), finished = hn::Set(du, uint32_t{kFinished});
  const bool last = s.step.bounce >= plan.settings.max_depth;  // nothing scatters any more
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const Vec3 o = LoadVec3(s.o_x, s.o_y, s.o_z, i), dir = LoadVec3(s.d_x, s.d_y, s.d_z, i);
    const MF alive = hn::Gt(MaxElement(LoadVec3(s.beta_r, s.beta_g, s.beta_b, i)), hn::Zero(d));
    const Hits hits = ClosestHit(plan, o, dir, alive);
    // Missing rays look up primitive 0, and then do not use what they find.
    const auto none = hn::Eq(hits.prim, hn::Set(DI(), kNoHit));
    VU bin = hn::GatherIndex(du, plan.prim_bin.data(), hn::IfThenZeroElse(none, hits.prim));
    if (last) bin = hn::IfThenElse(hn::Eq(bin, emitter), emitter, finished);
    hn::Store(hn::IfThenElse(hn::RebindMask(du, none), finished, bin), du, s.bin + i);
    hn::Store(hn::BitCast(du, hits.prim), du, s.prim + i);
    hn::Store(hits.t, d, s.t + i);
    hn::Store(hits.u, d, s.u + i);
    hn::Store(hits.v, d, s.v + i);
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
