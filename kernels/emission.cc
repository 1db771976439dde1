#include "kernels/kernels.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/emission.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/records-inl.h"
#include "kernels/shading-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

void Emission(const Plan& plan, const PathState& s, Range range) {
  const DF d;
  const DI di;
  const VF zero = hn::Zero(d), one = Splat(1.0f);
  const VF light_samples = Splat(static_cast<float>(plan.settings.light_samples));
  const Direct direct = plan.settings.direct;
  const bool spheres = std::ranges::any_of(plan.lights, [](const PlanLight& light) { return light.patches == 0; });
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const VI prim = hn::BitCast(di, hn::Load(DU(), s.prim + i));
    const Vec3 dir = LoadVec3(s.d_x, s.d_y, s.d_z, i);
    const VF t = hn::Load(d, s.t + i);
    Vec3 n;
    VF size;
    LaneRecords(plan.prim_shape.data(), 4, s.prim + i).Get4(0, n.x, n.y, n.z, size);
    if (spheres) {
      const MF is_sphere = hn::RebindMask(d, hn::Gt(prim, hn::Set(di, static_cast<int32_t>(plan.triangles) - 1)));
      const Vec3 hit = MulAdd(t, dir, LoadVec3(s.o_x, s.o_y, s.o_z, i));
      n = IfThenElse(is_sphere, Normalize(Sub(hit, n)), n);
    }
    const VF cosine = hn::Neg(Dot(n, dir));

    uint32_t light[hn::MaxLanes(d)];
    for (size_t k = 0; k < hn::Lanes(d); ++k) light[k] = plan.prim_light[s.prim[i + k]];
    Vec3 radiance;
    VF area;
    LaneRecords(plan.light_table.data(), 4, light).Get4(0, radiance.x, radiance.y, radiance.z, area);

    const VF pdf = hn::Load(d, s.pdf + i);
    const MF alone = hn::Eq(pdf, zero);    // no light sample could have made this path
    const MF counted = hn::Lt(pdf, zero);  // kConnected
    VF weight = one;
    if (direct == Direct::kMis) {
      const VF light_pdf = hn::Div(hn::Mul(light_samples, hn::Mul(t, t)), hn::Mul(area, cosine));
      const VF ratio = hn::Div(light_pdf, pdf);
      weight = hn::IfThenElse(alone, one, hn::Div(one, hn::MulAdd(ratio, ratio, one)));
    } else if (direct != Direct::kBsdf) {
      weight = hn::IfThenElseZero(alone, one);
    }
    weight = hn::IfThenElseZero(hn::Gt(cosine, zero), weight);
    weight = hn::IfThenZeroElse(hn::Or(counted, ByLightPaths(s, i)), weight);

    const Vec3 beta = LoadVec3(s.beta_r, s.beta_g, s.beta_b, i);
    const Vec3 L = LoadVec3(s.L_r, s.L_g, s.L_b, i);
    StoreVec3(MulAdd(weight, Mul(beta, radiance), L), s.L_r, s.L_g, s.L_b, i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(Emission, emission);
}  // namespace lanewise
#endif
