#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/shade_glass.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/fresnel-inl.h"
#include "kernels/rng-inl.h"
#include "kernels/shading-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

void ShadeGlass(const Plan& plan, const PathState& s, Range range) {
  const DF df;
  const VF one = Splat(1.0f);
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(df)) {
    const Vec3 d = LoadVec3(s.d_x, s.d_y, s.d_z, i);
    const Vec3 outward = LoadVec3(s.s_x, s.s_y, s.s_z, i);
    const MF inside = hn::Gt(Dot(d, outward), hn::Zero(df));
    const Vec3 normal = ViewerSide(outward, d);
    const VF c = hn::Min(AbsDot(d, outward), one);

    const LaneMaterials material(plan, s, i);
    Vec3 transmittance;
    VF ior;
    static_assert(kIor == kTransmittance + 3);
    material.Get4(kTransmittance, transmittance.x, transmittance.y, transmittance.z, ior);
    const VF n_i = hn::IfThenElse(inside, ior, one), n_t = hn::IfThenElse(inside, one, ior);
    const Dielectric fresnel = FresnelDielectric(plan.settings.fresnel, c, n_i, n_t);
    const VF eta = hn::Div(n_i, n_t);

    const MF reflects = hn::Lt(DrawGlassLobe(plan, s, i), fresnel.reflectance);
    const Vec3 reflected = MulAdd(hn::Add(c, c), normal, d);
    const Vec3 refracted = MulAdd(hn::MulSub(eta, c, fresnel.cos_t), normal, Scale(eta, d));
    const Vec3 wi = Normalize(IfThenElse(reflects, reflected, refracted));
    const Vec3 o =
        OffsetOrigin(LoadVec3(s.o_x, s.o_y, s.o_z, i), LoadVec3(s.n_x, s.n_y, s.n_z, i), hn::Load(df, s.err + i), wi);
    const Vec3 through = Scale(Squeeze(s.step, eta), transmittance);
    const Vec3 weight = IfThenElse(reflects, material.GetVec3(kReflectance), through);
    StoreVec3(Mul(LoadVec3(s.beta_r, s.beta_g, s.beta_b, i), weight), s.beta_r, s.beta_g, s.beta_b, i);
    StoreVec3(o, s.o_x, s.o_y, s.o_z, i);
    StoreVec3(wi, s.d_x, s.d_y, s.d_z, i);
    hn::Store(PdfAfterDelta(plan, s, i, hn::AndNot(inside, reflects)), df, s.pdf + i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(ShadeGlass, shade_glass);
}  // namespace lanewise
#endif
