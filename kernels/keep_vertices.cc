#include "core/path_reuse.h"
#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/keep_vertices.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// Where the surface is shaded by its own normal.
HWY_INLINE MF IsFlat(const PathState& s, size_t i) {
  const Vec3 n = LoadVec3(s.n_x, s.n_y, s.n_z, i), shading = LoadVec3(s.s_x, s.s_y, s.s_z, i);
  const Vec3 apart = Sub(Scale(hn::CopySign(Splat(1.0f), Dot(n, shading)), n), shading);
  return hn::Le(Dot(apart, apart), Splat(kFlatness * kFlatness));
}

// The surface's normal on the side that dir points to.
HWY_INLINE Vec3 NormalTowards(const PathState& s, size_t i, const Vec3& dir) {
  const Vec3 n = LoadVec3(s.n_x, s.n_y, s.n_z, i);
  return Scale(hn::CopySign(Splat(1.0f), Dot(n, dir)), n);
}

// The slots of those that keep something; the others' goes to the padding's slot.
HWY_INLINE VI SlotsWhere(const PathState& s, size_t i, MF keeps) {
  const VU slot = hn::IfThenElse(hn::RebindMask(DU(), keeps), hn::Load(DU(), s.slot + i), hn::Set(DU(), s.capacity));
  return hn::BitCast(DI(), slot);
}

void KeepFirst(const Plan&, const PathState& s, Range range) {
  const DF d;
  const KeptVertices& kept = s.kept;
  const VF zero = hn::Zero(d), next = Splat(static_cast<float>(s.step.bounce + 1));
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const VI own_slot = hn::BitCast(DI(), hn::Load(DU(), s.slot + i));
    const MF first = hn::Eq(hn::GatherIndex(d, kept.bounce, own_slot), zero);
    if (hn::AllFalse(d, first)) continue;
    const Vec3 beta = LoadVec3(s.beta_r, s.beta_g, s.beta_b, i);
    const MF keeps = hn::And(first, hn::And(IsFlat(s, i), hn::Gt(MaxElement(beta), zero)));
    hn::ScatterIndex(hn::IfThenElse(keeps, next, Splat(-1.0f)), d, kept.bounce, SlotsWhere(s, i, first));
    const VI slot = SlotsWhere(s, i, keeps);
    ScatterVec3(LoadVec3(s.o_x, s.o_y, s.o_z, i), kept.x_x, kept.x_y, kept.x_z, slot);
    const Vec3 n = NormalTowards(s, i, LoadVec3(s.d_x, s.d_y, s.d_z, i));
    ScatterVec3(n, kept.n_x, kept.n_y, kept.n_z, slot);
    ScatterVec3(beta, kept.f_r, kept.f_g, kept.f_b, slot);
  }
}

void KeepSecond(const Plan&, const PathState& s, Range range) {
  const DF d;
  const KeptVertices& kept = s.kept;
  const VF one = Splat(1.0f), least = Splat(kLeastShared);
  const VF bounce = Splat(static_cast<float>(s.step.bounce));
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const VI own_slot = hn::BitCast(DI(), hn::Load(DU(), s.slot + i));
    const MF second = hn::Eq(hn::GatherIndex(d, kept.bounce, own_slot), bounce);
    if (hn::AllFalse(d, second)) continue;
    const Vec3 beta = LoadVec3(s.beta_r, s.beta_g, s.beta_b, i);
    const VF most = MaxElement(beta);
    const MF keeps = hn::And(second, hn::And(IsFlat(s, i), hn::Gt(most, least)));
    const VI slot = SlotsWhere(s, i, keeps);
    const Vec3 n = NormalTowards(s, i, Neg(LoadVec3(s.d_x, s.d_y, s.d_z, i)));
    ScatterVec3(MulAdd(hn::Load(d, s.err + i), n, LoadVec3(s.o_x, s.o_y, s.o_z, i)), kept.y_x, kept.y_y, kept.y_z,
                slot);
    ScatterVec3(n, kept.m_x, kept.m_y, kept.m_z, slot);
    const Vec3 L = LoadVec3(s.L_r, s.L_g, s.L_b, i);
    ScatterVec3(L, kept.L_r, kept.L_g, kept.L_b, slot);
    hn::ScatterIndex(hn::Div(one, hn::IfThenElse(keeps, most, one)), d, kept.gain, slot);
    StoreVec3(IfThenElseZero(hn::Not(keeps), L), s.L_r, s.L_g, s.L_b, i);
    StoreVec3(IfThenElse(keeps, {most, most, most}, beta), s.beta_r, s.beta_g, s.beta_b, i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(KeepFirst, keep_first);
LANEWISE_KERNEL(KeepSecond, keep_second);
}  // namespace lanewise
#endif
