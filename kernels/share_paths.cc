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

// Of slots i, i + 1, ... their partner's.
HWY_INLINE VI Partners(size_t i, uint32_t partner) {
  const DI d;
  return hn::Xor(hn::Iota(d, static_cast<int32_t>(i)), hn::Set(d, static_cast<int32_t>(partner)));
}

// From the first vertices of the slots `firsts` to the second ones of slots i, i + 1, ...
struct Connection {
  Vec3 x, n;   // as KeptVertices has them
  Vec3 l;      // y - x
  VF density;  // pi times that, by area, of y from x; 0: there is no such connection
};

HWY_INLINE Connection Connect(const KeptVertices& kept, size_t i, VI firsts) {
  const DF d;
  Connection c;
  c.x = GatherVec3(kept.x_x, kept.x_y, kept.x_z, firsts);
  c.n = GatherVec3(kept.n_x, kept.n_y, kept.n_z, firsts);
  c.l = Sub(LoadVec3(kept.y_x, kept.y_y, kept.y_z, i), c.x);
  const Vec3 m = LoadVec3(kept.m_x, kept.m_y, kept.m_z, i);
  const VF leaves = Dot(c.n, c.l), arrives = hn::Neg(Dot(m, c.l)), square = Dot(c.l, c.l);
  const VF zero = hn::Zero(d);
  const MF met = hn::Eq(hn::GatherIndex(d, kept.bounce, firsts), hn::Load(d, kept.bounce + i));
  const MF shared = hn::And(hn::And(met, hn::Gt(hn::Load(d, kept.gain + i), zero)),
                            hn::And(hn::Gt(leaves, zero), hn::Gt(arrives, zero)));
  c.density = hn::IfThenElseZero(shared, hn::Mul(hn::Div(leaves, square), hn::Div(arrives, square)));
  return c;
}

// A channel of c, and so of L, for each of the others.
static_assert(kPathsTogether == 4);

void ConnectPaths(const Plan&, const PathState& s, Range range) {
  const DF d;
  const VF zero = hn::Zero(d);
  const uint32_t partner = s.step.partner;
  float* const c[] = {s.c_r, s.c_g, s.c_b};
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const Connection connection = Connect(s.kept, i, Partners(i, partner));
    StoreVec3(connection.x, s.o_x, s.o_y, s.o_z, i);
    StoreVec3(connection.n, s.n_x, s.n_y, s.n_z, i);
    StoreVec3(connection.l, s.l_x, s.l_y, s.l_z, i);
    hn::Store(zero, d, s.err + i);
    for (uint32_t channel = 0; channel < 3; ++channel) {
      hn::Store(channel + 1 == partner ? connection.density : zero, d, c[channel] + i);
    }
    if (partner == 1) StoreVec3({zero, zero, zero}, s.L_r, s.L_g, s.L_b, i);
  }
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
    const VF own = Connect(kept, i, Partners(i, 0)).density;
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
  const float* const weights[] = {s.l_pdf, s.L_r, s.L_g, s.L_b};
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const VF zero = hn::Zero(d);
    Vec3 got = {zero, zero, zero};
    for (uint32_t partner = 0; partner < kPathsTogether; ++partner) {
      const VI from = Partners(i, partner);
      got = MulAdd(hn::GatherIndex(d, weights[partner], from), GatherVec3(s.c_r, s.c_g, s.c_b, from), got);
    }
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
