#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/environment.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/environment-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

void Environment(const Plan& plan, const PathState& s, Range range) {
  const DF d;
  const VF one = Splat(1.0f);
  const VF light_samples = Splat(static_cast<float>(plan.settings.light_samples));
  const Direct direct = plan.settings.direct;
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const Sky sky = SkyAlong(plan.environment, LoadVec3(s.d_x, s.d_y, s.d_z, i));
    const VF pdf = hn::Load(d, s.pdf + i);
    const MF sampled = hn::Gt(pdf, hn::Zero(d));  // an environment sample could have made this path
    VF weight = one;
    if (direct == Direct::kMis) {
      const VF ratio = hn::Div(hn::Mul(light_samples, sky.pdf), pdf);
      weight = hn::IfThenElse(sampled, hn::Div(one, hn::MulAdd(ratio, ratio, one)), one);
    } else if (direct != Direct::kBsdf) {
      weight = hn::IfThenZeroElse(sampled, one);
    }
    const Vec3 beta = LoadVec3(s.beta_r, s.beta_g, s.beta_b, i);
    const Vec3 L = LoadVec3(s.L_r, s.L_g, s.L_b, i);
    StoreVec3(MulAdd(weight, Mul(beta, sky.radiance), L), s.L_r, s.L_g, s.L_b, i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(Environment, environment);
}  // namespace lanewise
#endif
