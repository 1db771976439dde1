#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/shade_rough_glass.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/fresnel-inl.h"
#include "kernels/microfacet-inl.h"
#include "kernels/rng-inl.h"
#include "kernels/shading-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

struct RoughGlass {
  Vec3 reflectance, transmittance;
  VF alpha;
  VF n_i, n_t;  // indices on the viewer's side and beyond
  MF denser;    // beyond
  VF e;         // |n_t^2 - n_i^2|

  RoughGlass(const Plan& plan, const PathState& s, size_t i, MF inside) {
    static_assert(kIor == kTransmittance + 3);
    const LaneMaterials material(plan, s, i);
    const VF one = Splat(1.0f);
    VF ior;
    material.Get4(kTransmittance, transmittance.x, transmittance.y, transmittance.z, ior);
    reflectance = material.GetVec3(kReflectance);
    alpha = hn::Max(material.Get(kAlpha), Splat(kMinAlpha));
    n_i = hn::IfThenElse(inside, ior, one);
    n_t = hn::IfThenElse(inside, one, ior);
    denser = hn::Gt(n_t, n_i);
    // The bound is met by padding alone.
    e = hn::Max(hn::Abs(hn::Mul(hn::Sub(n_t, n_i), hn::Add(n_t, n_i))), Splat(1e-6f));
  }

  HWY_INLINE Vec3 Tint(MF reflects, const Step& step) const {
    return IfThenElse(reflects, reflectance, Scale(Squeeze(step, hn::Div(n_i, n_t)), transmittance));
  }

  // Density of the refracted direction for that of the visible normals over wo.m, c and cos_t the cosines of both directions
  // at the microfacet (Walter et al. 2007, eq. 17). q = n_i c + n_t cos_t; with Snell's law the usual denominator,
  // n_t cos_t - n_i c, is e / q, in which nothing cancels.
  HWY_INLINE VF RefractedPdf(VF visible, VF c, VF cos_t, VF q) const {
    const VF inverse = hn::Div(q, e);
    return hn::Mul(hn::Mul(hn::Mul(visible, c), hn::Mul(hn::Mul(n_t, n_t), cos_t)), hn::Mul(inverse, inverse));
  }
};

void LightRoughGlass(const Plan& plan, const PathState& s, Range range) {
  const DF df;
  const VF zero = hn::Zero(df), one = Splat(1.0f), half = Splat(0.5f);
  const LightTerms light(plan, s.step);
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(df)) {
    const Vec3 d = LoadVec3(s.d_x, s.d_y, s.d_z, i);
    const Vec3 outward = LoadVec3(s.s_x, s.s_y, s.s_z, i);
    const Vec3 normal = ViewerSide(outward, d);
    const Vec3 wi = Normalize(LoadVec3(s.l_x, s.l_y, s.l_z, i));
    const VF l_pdf = hn::Load(df, s.l_pdf + i);
    const VF cos_i = Dot(wi, normal), cos_o = hn::Max(hn::Neg(Dot(d, normal)), zero);
    const MF reflects = hn::Gt(cos_i, zero);
    const RoughGlass glass(plan, s, i, hn::Gt(Dot(d, outward), zero));

    // The microfacet's normal halves wo + wi, or n_i wo + n_t wi, on the side of the smaller index. Parts across the normal as
    // vectors, as for metals.
    const VF share_o = hn::IfThenElse(reflects, one, glass.n_i), share_i = hn::IfThenElse(reflects, one, glass.n_t);
    const Vec3 across_o = Neg(MulAdd(cos_o, normal, d));
    const Vec3 across_i = MulAdd(hn::Neg(cos_i), normal, wi);
    const Vec3 across = MulAdd(share_o, across_o, Scale(share_i, across_i));
    const VF sum = hn::MulAdd(share_o, cos_o, hn::Mul(share_i, cos_i));
    const VF along = hn::IfThenElse(hn::AndNot(reflects, glass.denser), hn::Neg(sum), sum);
    const HalfVector h = MakeHalfVector(along, Dot(across, across));
    // By Snell's law |h| = |n_t cos_t - n_i c| and e / |h| = n_t cos_t + n_i c; above e nothing is refracted.
    const VF length = hn::Sqrt(h.length2), q = hn::Div(glass.e, length);
    const VF difference = hn::IfThenElse(glass.denser, length, hn::Neg(length));
    const VF c =
        hn::Min(hn::IfThenElse(reflects, h.cos, hn::Div(hn::Mul(half, hn::Sub(q, difference)), glass.n_i)), one);
    const VF cos_t = hn::Min(hn::Div(hn::Mul(half, hn::Add(q, difference)), glass.n_t), one);
    const MF refracts = hn::And(hn::Gt(along, zero), hn::Lt(h.length2, glass.e));
    const MF lit = hn::And(light.Wanted(plan, s, i, LoadVec3(s.l_x, s.l_y, s.l_z, i)),
                           hn::And(hn::Or(reflects, refracts), hn::Gt(l_pdf, zero)));

    const Dielectric fresnel = FresnelDielectric(plan.settings.fresnel, hn::Max(c, zero), glass.n_i, glass.n_t);
    const SlopeView view_o = ViewSlopes(cos_o, hn::Sqrt(Dot(across_o, across_o)), glass.alpha);
    const SlopeView view_i = ViewSlopes(hn::Abs(cos_i), hn::Sqrt(Dot(across_i, across_i)), glass.alpha);
    const VF visible = hn::Mul(BeckmannD(h.tan2, glass.alpha), SmithG1OverCos(view_o));
    const VF pdf = hn::IfThenElse(reflects, hn::Mul(fresnel.reflectance, hn::Mul(Splat(0.25f), visible)),
                                  hn::Mul(fresnel.transmittance, glass.RefractedPdf(visible, c, cos_t, q)));
    const VF weight = hn::Mul(hn::Mul(pdf, SmithG1(view_i)), light.Weight(l_pdf, pdf));
    const Vec3 added = Scale(weight, Mul(glass.Tint(reflects, s.step), light.Radiance(s, i)));
    StoreVec3(IfThenElseZero(lit, Mul(LoadVec3(s.beta_r, s.beta_g, s.beta_b, i), added)), s.c_r, s.c_g, s.c_b, i);
  }
}

void ShadeRoughGlass(const Plan& plan, const PathState& s, Range range) {
  const DF df;
  const VF zero = hn::Zero(df), one = Splat(1.0f);
  // -H looks for lights on the viewer's side alone: beyond, they are met as behind a delta lobe.
  const MF refraction_finds_light =
      plan.settings.direct == Direct::kHemisphere ? hn::Eq(zero, zero) : hn::Lt(one, zero);
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(df)) {
    const Vec3 d = LoadVec3(s.d_x, s.d_y, s.d_z, i);
    const Vec3 outward = LoadVec3(s.s_x, s.s_y, s.s_z, i);
    const Vec3 normal = ViewerSide(outward, d);
    Vec3 b1, b2;
    Frame(normal, b1, b2);
    const Vec3 wo = {hn::Neg(Dot(d, b1)), hn::Neg(Dot(d, b2)), hn::Max(hn::Neg(Dot(d, normal)), zero)};
    const RoughGlass glass(plan, s, i, hn::Gt(Dot(d, outward), zero));

    const auto [u, v] = DrawFacet(plan, s, i);
    const VF sine = hn::Sqrt(hn::MulAdd(wo.x, wo.x, hn::Mul(wo.y, wo.y)));
    const SlopeView view_o = ViewSlopes(wo.z, sine, glass.alpha);
    const FacetSlopes m = SampleVisibleNormal(view_o, wo, sine, glass.alpha, u, v);
    const VF tan2 = hn::MulAdd(m.x, m.x, hn::Mul(m.y, m.y));
    const VF m_z = hn::Div(one, hn::Sqrt(hn::Add(one, tan2)));
    const Vec3 facet = {hn::Mul(m.x, m_z), hn::Mul(m.y, m_z), m_z};
    const VF wo_m = hn::Mul(hn::MulAdd(wo.x, m.x, hn::MulAdd(wo.y, m.y, wo.z)), m_z);
    const VF c = hn::Min(hn::Max(wo_m, zero), one);

    const Dielectric fresnel = FresnelDielectric(plan.settings.fresnel, c, glass.n_i, glass.n_t);
    const MF reflects = hn::Lt(DrawRandom(plan, s, i, kSetChoice).u[kDrawLobe], fresnel.reflectance);
    const VF eta = hn::Div(glass.n_i, glass.n_t);
    const Vec3 reflected = MulAdd(hn::Add(c, c), facet, Neg(wo));
    const Vec3 refracted = MulAdd(hn::MulSub(eta, c, fresnel.cos_t), facet, Scale(hn::Neg(eta), wo));
    const Vec3 local = IfThenElse(reflects, reflected, refracted);
    // Where it should go by the microfacet; elsewhere other microfacets are in the way.
    const MF leaves = hn::And(hn::Gt(hn::IfThenElse(reflects, local.z, hn::Neg(local.z)), zero), hn::Gt(c, zero));

    const VF sine_i = hn::Sqrt(hn::MulAdd(local.x, local.x, hn::Mul(local.y, local.y)));
    const VF weight = SmithG1(ViewSlopes(hn::Abs(local.z), sine_i, glass.alpha));
    const VF visible = hn::Mul(BeckmannD(tan2, glass.alpha), SmithG1OverCos(view_o));
    const VF q = hn::MulAdd(glass.n_i, c, hn::Mul(glass.n_t, fresnel.cos_t));
    const VF pdf = hn::IfThenElse(
        reflects, hn::Mul(fresnel.reflectance, hn::Mul(Splat(0.25f), visible)),
        hn::IfThenZeroElse(refraction_finds_light,
                           hn::Mul(fresnel.transmittance, glass.RefractedPdf(visible, c, fresnel.cos_t, q))));

    const Vec3 wi = Normalize(ToWorld(local, b1, b2, normal));
    const Vec3 beta = Mul(LoadVec3(s.beta_r, s.beta_g, s.beta_b, i), Scale(weight, glass.Tint(reflects, s.step)));
    const Vec3 o =
        OffsetOrigin(LoadVec3(s.o_x, s.o_y, s.o_z, i), LoadVec3(s.n_x, s.n_y, s.n_z, i), hn::Load(df, s.err + i), wi);
    StoreVec3(IfThenElseZero(leaves, beta), s.beta_r, s.beta_g, s.beta_b, i);
    StoreVec3(o, s.o_x, s.o_y, s.o_z, i);
    StoreVec3(wi, s.d_x, s.d_y, s.d_z, i);
    hn::Store(hn::IfThenElseZero(leaves, pdf), df, s.pdf + i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(LightRoughGlass, light_rough_glass);
LANEWISE_KERNEL(ShadeRoughGlass, shade_rough_glass);
}  // namespace lanewise
#endif
