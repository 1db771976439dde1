#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/gather_emission.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/closest-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

void GatherEmission(const Plan& plan, const PathState& s, Range range) {
  const DF d;
  const DI di;
  const DU du;
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const Vec3 c = LoadVec3(s.c_r, s.c_g, s.c_b, i);
    const MF wanted = hn::Gt(MaxElement({hn::Abs(c.x), hn::Abs(c.y), hn::Abs(c.z)}), hn::Zero(d));
    if (hn::AllFalse(d, wanted)) continue;
    const Vec3 l = LoadVec3(s.l_x, s.l_y, s.l_z, i), n = LoadVec3(s.n_x, s.n_y, s.n_z, i);
    const Vec3 o = OffsetOrigin(LoadVec3(s.o_x, s.o_y, s.o_z, i), n, hn::Load(d, s.err + i), l);
    const Hits hits = ClosestHit(plan, o, l, wanted);

    // Missing rays look up primitive 0, and then do not use what they find.
    const auto none = hn::Eq(hits.prim, hn::Set(di, kNoHit));
    const VI prim = hn::IfThenZeroElse(none, hits.prim);
    const VU bin = hn::GatherIndex(du, plan.prim_bin.data(), prim);
    Vec3 front = GatherVec3(plan.prim_shape.data(), hn::ShiftLeft<2>(prim));
    if (plan.spheres > 0) {
      // From its center to the hit: the outside's normal, not normalised.
      const MF sphere = hn::RebindMask(d, hn::Gt(prim, hn::Set(di, static_cast<int32_t>(plan.triangles) - 1)));
      front = IfThenElse(sphere, Sub(MulAdd(hits.t, l, o), front), front);
    }
    const MF seen = hn::And(
        hn::And(hn::RebindMask(d, hn::Eq(bin, hn::Set(du, uint32_t{kEmitter}))), hn::Lt(Dot(front, l), hn::Zero(d))),
        hn::RebindMask(d, hn::Gt(hits.prim, hn::Set(di, kNoHit))));
    const MF adds = hn::And(wanted, seen);
    if (hn::AllFalse(d, adds)) continue;
    const VI light = hn::BitCast(di, hn::GatherIndex(du, plan.prim_light.data(), prim));
    const Vec3 radiance = GatherVec3(plan.light_table.data(), hn::ShiftLeft<2>(light));
    StoreVec3(Add(LoadVec3(s.L_r, s.L_g, s.L_b, i), IfThenElseZero(adds, Mul(c, radiance))), s.L_r, s.L_g, s.L_b, i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(GatherEmission, gather_emission);
}  // namespace lanewise
#endif
