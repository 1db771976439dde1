#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/sample_light.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/light_point-inl.h"
#include "kernels/rng-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

void SampleLight(const Plan& plan, const PathState& s, Range range) {
  const DF d;
  const PlanLight& light = plan.lights[s.step.light];
  const VF area = Splat(light.area), zero = hn::Zero(d);
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const Random4 random = DrawLight(plan, s, i);
    const LightPoint at = SampleLightPoint(plan, light, random);
    const Vec3 p = LoadVec3(s.o_x, s.o_y, s.o_z, i);
    const Vec3 n = LoadVec3(s.n_x, s.n_y, s.n_z, i);
    const Vec3 origin = OffsetOrigin(p, n, hn::Load(d, s.err + i), Sub(at.q, p));
    const Vec3 l = Sub(at.q, origin);
    const VF distance2 = Dot(l, l);
    const VF cosine_distance = hn::Neg(Dot(l, at.n));
    // distance^2 / (area cos) with cos = cosine_distance / distance
    const VF pdf = hn::Div(hn::Mul(distance2, hn::Sqrt(distance2)), hn::Mul(area, cosine_distance));
    StoreVec3(l, s.l_x, s.l_y, s.l_z, i);
    hn::Store(hn::IfThenElseZero(hn::Gt(cosine_distance, zero), pdf), d, s.l_pdf + i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(SampleLight, sample_light);
}  // namespace lanewise
#endif
