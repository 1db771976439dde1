#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/roulette.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/rng-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

void Roulette(const Plan& plan, const PathState& s, Range range) {
  if (s.step.bounce < kRouletteBounce) return;
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(DF())) {
    const Vec3 beta = LoadVec3(s.beta_r, s.beta_g, s.beta_b, i);
    const VF q = hn::Min(Splat(1.0f), MaxElement(beta));
    const VF u = DrawRandom(plan, s, i, kSetChoice).u[kDrawRoulette];
    // q = 0 only where beta is 0, and then u < q fails: the quotient is never used.
    const VF scale = hn::IfThenElseZero(hn::Lt(u, q), hn::Div(Splat(1.0f), hn::Max(q, Splat(1e-30f))));
    StoreVec3(Scale(scale, beta), s.beta_r, s.beta_g, s.beta_b, i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(Roulette, roulette);
}  // namespace lanewise
#endif
