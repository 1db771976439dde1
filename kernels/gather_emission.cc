#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/gather_emission.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/closest-inl.h"
#include "kernels/environment-inl.h"
#include "kernels/shadow-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// Rays of a batch and what they meet.
struct GatherBatch {
  static constexpr size_t kSize = 512;
  HWY_ALIGN float o[3][kSize], t[kSize], u[kSize], v[kSize];
  HWY_ALIGN uint32_t prim[kSize];
};

// Adds what the sky sends back along the rays that have missed.
HWY_INLINE void AddSky(const Plan& plan, const PathState& s, size_t i, MF missed) {
  if (hn::AllFalse(DF(), missed)) return;
  const Sky sky = SkyAlong(plan.environment, LoadVec3(s.l_x, s.l_y, s.l_z, i));
  const Vec3 added = IfThenElseZero(missed, Mul(LoadVec3(s.c_r, s.c_g, s.c_b, i), sky.radiance));
  StoreVec3(Add(LoadVec3(s.L_r, s.L_g, s.L_b, i), added), s.L_r, s.L_g, s.L_b, i);
}

// Adds what the lights that the rays at i of the state, j of the batch, have met send back along them.
HWY_INLINE void AddEmission(const Plan& plan, const PathState& s, size_t i, const GatherBatch& batch, size_t j) {
  const DF d;
  const DI di;
  const DU du;
  const VI hit = hn::BitCast(di, hn::Load(du, batch.prim + j));
  // Missing rays look up primitive 0, and then do not use what they find.
  const auto none = hn::Eq(hit, hn::Set(di, kNoHit));
  const VI prim = hn::IfThenZeroElse(none, hit);
  const VU bin = hn::GatherIndex(du, plan.prim_bin.data(), prim);
  const Vec3 l = LoadVec3(s.l_x, s.l_y, s.l_z, i);
  Vec3 front = GatherVec3(plan.prim_shape.data(), hn::ShiftLeft<2>(prim));
  if (plan.spheres > 0) {
    // From its center to the hit: the outside's normal, not normalised.
    const MF sphere = hn::RebindMask(d, hn::Gt(prim, hn::Set(di, static_cast<int32_t>(plan.triangles) - 1)));
    const Vec3 o = LoadVec3(batch.o[0], batch.o[1], batch.o[2], j);
    front = IfThenElse(sphere, Sub(MulAdd(hn::Load(d, batch.t + j), l, o), front), front);
  }
  const Vec3 c = LoadVec3(s.c_r, s.c_g, s.c_b, i);
  const MF seen = hn::And(
      hn::And(hn::RebindMask(d, hn::Eq(bin, hn::Set(du, uint32_t{kEmitter}))), hn::Lt(Dot(front, l), hn::Zero(d))),
      hn::RebindMask(d, hn::Gt(hit, hn::Set(di, kNoHit))));
  if (!plan.environment.empty()) AddSky(plan, s, i, hn::And(IsWanted(c), hn::RebindMask(d, none)));
  const MF adds = hn::And(IsWanted(c), seen);
  if (hn::AllFalse(d, adds)) return;
  const VI light = hn::BitCast(di, hn::GatherIndex(du, plan.prim_light.data(), prim));
  const Vec3 radiance = GatherVec3(plan.light_table.data(), hn::ShiftLeft<2>(light));
  StoreVec3(Add(LoadVec3(s.L_r, s.L_g, s.L_b, i), IfThenElseZero(adds, Mul(c, radiance))), s.L_r, s.L_g, s.L_b, i);
}

void GatherEmission(const Plan& plan, const PathState& s, Range range) {
  const DF d;
  GatherBatch batch;
  for (size_t begin = range.begin; begin < range.end; begin += GatherBatch::kSize) {
    const size_t end = std::min<size_t>(range.end, begin + GatherBatch::kSize);
    const auto ray = [&](size_t j, Vec3& o, Vec3& l) HWY_ATTR {
      const size_t i = begin + j;
      l = LoadVec3(s.l_x, s.l_y, s.l_z, i);
      o = ShadowOrigin(s, i, l);
      StoreVec3(o, batch.o[0], batch.o[1], batch.o[2], j);
      return IsWanted(LoadVec3(s.c_r, s.c_g, s.c_b, i));
    };
    ClosestHits(plan, {batch.t, batch.u, batch.v, batch.prim}, 0, end - begin, ray);
    for (size_t i = begin; i < end; i += hn::Lanes(d)) AddEmission(plan, s, i, batch, i - begin);
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
