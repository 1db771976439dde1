#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/sample_hemisphere.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/rng-inl.h"
#include "kernels/sampling-inl.h"
#include "kernels/shading-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

void SampleHemisphere(const Plan& plan, const PathState& s, Range range) {
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(DF())) {
    const Vec3 normal = ViewerSide(LoadVec3(s.s_x, s.s_y, s.s_z, i), LoadVec3(s.d_x, s.d_y, s.d_z, i));
    const Random4 random = DrawLight(plan, s, i);
    Vec3 b1, b2;
    Frame(normal, b1, b2);
    const Vec3 l = ToWorld(UniformHemisphere(random.u[kDrawLightU], random.u[kDrawLightV]), b1, b2, normal);
    StoreVec3(l, s.l_x, s.l_y, s.l_z, i);
    hn::Store(Splat(0.5f * kInvPi), DF(), s.l_pdf + i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(SampleHemisphere, sample_hemisphere);
}  // namespace lanewise
#endif
