#include "core/path_reuse.h"
#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/share_paths.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// A square fills a block of 128 bits: partners are a shuffle away.
static_assert(kPathsTogether == 4);

// Of slots i, i + 1, ... what slots i ^ kPartner, (i + 1) ^ kPartner, ... have.
template <uint32_t kPartner>
HWY_INLINE VF LoadPartners(const float* field, size_t i) {
  const DF d;
#if HWY_TARGET == HWY_SCALAR
  return hn::Load(d, field + (i ^ kPartner));
#else
  const VF own = hn::Load(d, field + i);
  if constexpr (kPartner == 1) return hn::Shuffle2301(own);
  if constexpr (kPartner == 2) return hn::Shuffle1032(own);
  if constexpr (kPartner == 3) return hn::Shuffle0123(own);
  return own;
#endif
}
template <uint32_t kPartner>
HWY_INLINE Vec3 LoadPartners(const float* x, const float* y, const float* z, size_t i) {
  return {LoadPartners<kPartner>(x, i), LoadPartners<kPartner>(y, i), LoadPartners<kPartner>(z, i)};
}

// From the first vertices of the slots' partners to the second ones of slots i, i + 1, ...
struct Connection {
  Vec3 x, n;   // as KeptVertices has them
  Vec3 l;      // y - x
  VF density;  // pi times that, by area, of y from x; 0: there is no such connection
};

template <uint32_t kPartner>
HWY_INLINE Connection Connect(const KeptVertices& kept, size_t i) {
  const DF d;
  Connection c;
  c.x = LoadPartners<kPartner>(kept.x_x, kept.x_y, kept.x_z, i);
  c.n = LoadPartners<kPartner>(kept.n_x, kept.n_y, kept.n_z, i);
  c.l = Sub(LoadVec3(kept.y_x, kept.y_y, kept.y_z, i), c.x);
  const Vec3 m = LoadVec3(kept.m_x, kept.m_y, kept.m_z, i);
  const VF leaves = Dot(c.n, c.l), arrives = hn::Neg(Dot(m, c.l)), square = Dot(c.l, c.l);
  const VF zero = hn::Zero(d);
  const MF met = hn::Eq(LoadPartners<kPartner>(kept.bounce, i), hn::Load(d, kept.bounce + i));
  const MF shared = hn::And(hn::And(met, hn::Gt(hn::Load(d, kept.gain + i), zero)),
                            hn::And(hn::Gt(leaves, zero), hn::Gt(arrives, zero)));
  c.density = hn::IfThenElseZero(shared, hn::Mul(hn::Div(leaves, square), hn::Div(arrives, square)));
  return c;
}

// A channel of c, and so of L, for each of the others.
template <uint32_t kPartner>
HWY_INLINE void ConnectTo(const PathState& s, Range range) {
  const DF d;
  const VF zero = hn::Zero(d);
  float* const c[] = {s.c_r, s.c_g, s.c_b};
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const Connection connection = Connect<kPartner>(s.kept, i);
    StoreVec3(connection.x, s.o_x, s.o_y, s.o_z, i);
    StoreVec3(connection.n, s.n_x, s.n_y, s.n_z, i);
    StoreVec3(connection.l, s.l_x, s.l_y, s.l_z, i);
    hn::Store(zero, d, s.err + i);
    for (uint32_t channel = 0; channel < 3; ++channel) {
      hn::Store(channel + 1 == kPartner ? connection.density : zero, d, c[channel] + i);
    }
    if (kPartner == 1) StoreVec3({zero, zero, zero}, s.L_r, s.L_g, s.L_b, i);
  }
}

void ConnectPaths(const Plan&, const PathState& s, Range range) {
  if (s.step.partner == 1) ConnectTo<1>(s, range);
  if (s.step.partner == 2) ConnectTo<2>(s, range);
  if (s.step.partner == 3) ConnectTo<3>(s, range);
}

HWY_INLINE MF IsFinite(const Vec3& v) {
  return hn::And(hn::IsFinite(v.x), hn::And(hn::IsFinite(v.y), hn::IsFinite(v.z)));
}

// What each slot has to share: its radiance at y in c, and the weights with which its own pixel and its partners get it in l_pdf and
// L. What is its own alone stays in kept.L: all of an invalid sample, so that it is one, and its own pixel's.
void WeighShares(const PathState& s, Range range) {
  const DF d;
  const KeptVertices& kept = s.kept;
  const VF zero = hn::Zero(d), one = Splat(1.0f);
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const VF gain = hn::Load(d, kept.gain + i);
    const Vec3 result = LoadVec3(s.result_r, s.result_g, s.result_b, i), radiance = Scale(gain, result);
    const MF shares = hn::And(hn::Gt(gain, zero), IsFinite(radiance));
    const VF own = Connect<0>(kept, i).density;
    const Vec3 others = LoadVec3(s.L_r, s.L_g, s.L_b, i);
    const VF sum = hn::Add(own, hn::Add(others.x, hn::Add(others.y, others.z)));
    // By rounding, a vertex may not see what its own path came to.
    const MF divides = hn::Gt(own, Splat(kLeastShared));
    const VF scale = hn::IfThenElseZero(divides, hn::Div(one, sum));
    hn::Store(hn::IfThenElse(divides, hn::Mul(own, scale), one), d, s.l_pdf + i);
    StoreVec3(Scale(scale, others), s.L_r, s.L_g, s.L_b, i);
    StoreVec3(IfThenElseZero(shares, radiance), s.c_r, s.c_g, s.c_b, i);
    const Vec3 before = LoadVec3(kept.L_r, kept.L_g, kept.L_b, i);
    StoreVec3(IfThenElse(shares, before, result), kept.L_r, kept.L_g, kept.L_b, i);
  }
}

void SharePaths(const Plan&, const PathState& s, Range range) {
  const DF d;
  const KeptVertices& kept = s.kept;
  WeighShares(s, range);
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const VF zero = hn::Zero(d);
    Vec3 got = MulAdd(hn::Load(d, s.l_pdf + i), LoadVec3(s.c_r, s.c_g, s.c_b, i), {zero, zero, zero});
    got = MulAdd(LoadPartners<1>(s.L_r, i), LoadPartners<1>(s.c_r, s.c_g, s.c_b, i), got);
    got = MulAdd(LoadPartners<2>(s.L_g, i), LoadPartners<2>(s.c_r, s.c_g, s.c_b, i), got);
    got = MulAdd(LoadPartners<3>(s.L_b, i), LoadPartners<3>(s.c_r, s.c_g, s.c_b, i), got);
    const Vec3 f = LoadVec3(kept.f_r, kept.f_g, kept.f_b, i), own = LoadVec3(kept.L_r, kept.L_g, kept.L_b, i);
    StoreVec3(Add(own, Mul(f, got)), s.result_r, s.result_g, s.result_b, i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(ConnectPaths, connect_paths);
LANEWISE_KERNEL(SharePaths, share_paths);
}  // namespace lanewise
#endif
