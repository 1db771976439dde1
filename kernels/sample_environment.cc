#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/sample_environment.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/environment-inl.h"
#include "kernels/rng-inl.h"
#include "kernels/sampling-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

void SampleEnvironment(const Plan& plan, const PathState& s, Range range) {
  const DF d;
  const DI di;
  const EnvironmentMap& map = plan.environment;
  const VF one = Splat(1.0f), reach = Splat(map.reach);
  const float* rows = &map.rows.data()->cdf;
  const VI width = hn::Set(di, static_cast<int32_t>(map.width));
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const Random4 random = DrawEnvironment(plan, s, i);
    SkyPlace place;
    place.row = FindInterval(rows, hn::Zero(di), 4, map.height + 1, random.u[kDrawSkyRow]);
    place.column =
        FindInterval(map.column_cdf.data(), hn::Mul(place.row, width), 1, map.width, random.u[kDrawSkyColumn]);
    place.x = random.u[kDrawSkyX];

    HWY_ALIGN uint32_t row[hn::MaxLanes(DU())];
    hn::Store(hn::BitCast(DU(), place.row), DU(), row);
    VF cdf, height, below, side;
    LaneRecords(rows, 4, row).Get4(0, cdf, height, below, side);
    height = hn::MulAdd(random.u[kDrawSkyY], below, height);
    const VF r = hn::Sqrt(hn::Mul(height, hn::Sub(Splat(2.0f), height)));  // sqrt(1 - z^2) without its cancellation
    const VF z = hn::Mul(side, hn::Sub(one, height));
    place.y = Clamp(hn::Sub(SkyRow(map, r, z), hn::ConvertTo(d, place.row)), 0.0f, 1.0f);

    VF u = hn::Mul(hn::Add(hn::Add(hn::ConvertTo(d, place.column), place.x), Splat(0.5f)),
                   Splat(1 / static_cast<float>(map.width)));
    u = hn::Sub(u, hn::IfThenElseZero(hn::Ge(u, one), one));
    VF sin, cos;
    SinCos2Pi(u, sin, cos);
    const VF across = hn::Mul(reach, r);
    const Vec3 l = {hn::Neg(hn::Mul(across, cos)), hn::Mul(across, sin), hn::Mul(reach, z)};
    StoreVec3(SkyToWorld(map, l), s.l_x, s.l_y, s.l_z, i);
    const Sky sky = SkyAt(map, place);
    hn::Store(sky.pdf, d, s.l_pdf + i);
    StoreVec3(sky.radiance, s.c_r, s.c_g, s.c_b, i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(SampleEnvironment, sample_environment);
}  // namespace lanewise
#endif
