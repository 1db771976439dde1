#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/shade_microfacet.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/fresnel-inl.h"
#include "kernels/microfacet-inl.h"
#include "kernels/rng-inl.h"
#include "kernels/sampling-inl.h"
#include "kernels/shading-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

struct Metal {
  VF alpha;
  Vec3 eta, k;

  Metal(const Plan& plan, const PathState& s, size_t i) {
    static_assert(kEta == kAlpha + 1);
    const LaneMaterials material(plan, s, i);
    material.Get4(kAlpha, alpha, eta.x, eta.y, eta.z);
    k = material.GetVec3(kK);
    alpha = hn::Max(alpha, Splat(kMinAlpha));
  }
};

void LightMicrofacet(const Plan& plan, const PathState& s, Range range) {
  const DF df;
  const VF zero = hn::Zero(df);
  const LightTerms light(plan, s.step);
  const CourseLobe course = plan.settings.course;
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(df)) {
    const Vec3 d = LoadVec3(s.d_x, s.d_y, s.d_z, i);
    const Vec3 normal = ViewerSide(LoadVec3(s.s_x, s.s_y, s.s_z, i), d);
    const Vec3 wi = Normalize(LoadVec3(s.l_x, s.l_y, s.l_z, i));
    const VF l_pdf = hn::Load(df, s.l_pdf + i);
    const VF cos_i = Dot(wi, normal), cos_o = hn::Max(hn::Neg(Dot(d, normal)), zero);
    const MF lit = hn::And(light.Wanted(plan, s, i, wi), hn::And(hn::Gt(cos_i, zero), hn::Gt(l_pdf, zero)));
    if (hn::AllFalse(df, lit)) {
      StoreVec3({zero, zero, zero}, s.c_r, s.c_g, s.c_b, i);
      continue;
    }

    const Metal metal(plan, s, i);
    const VF alpha = metal.alpha;
    // The parts across the normal, taken as vectors: 1 - cos^2 would lose them near it.
    const Vec3 across_o = Neg(MulAdd(cos_o, normal, d));
    const Vec3 across_i = MulAdd(hn::Neg(cos_i), normal, wi);
    const Vec3 across = Add(across_o, across_i);
    const HalfVector h = MakeHalfVector(hn::Add(cos_o, cos_i), Dot(across, across));
    const SlopeView view_o = ViewSlopes(cos_o, hn::Sqrt(Dot(across_o, across_o)), alpha);
    const SlopeView view_i = ViewSlopes(hn::Max(cos_i, zero), hn::Sqrt(Dot(across_i, across_i)), alpha);
    const VF distribution = BeckmannD(h.tan2, alpha);
    const VF visible_pdf = VisibleNormalPdf(distribution, view_o);
    const VF f_cos = course.any() ? CourseFCos(course, h.tan2, alpha, view_o, view_i)
                                  : hn::Mul(visible_pdf, SmithG1(view_i));  // without Fresnel

    VF pdf;
    switch (plan.settings.bsdf_sampling) {
      case BsdfSampling::kVndf:
        pdf = visible_pdf;
        break;
      case BsdfSampling::kNdf:
        pdf = NormalPdf(distribution, hn::Div(h.length2, hn::Add(h.z, h.z)));
        break;
      case BsdfSampling::kCosine:
        pdf = hn::Mul(cos_i, Splat(kInvPi));
        break;
    }
    const Vec3 fresnel = FresnelConductor(plan.settings.fresnel, h.cos, metal.eta, metal.k);
    const Vec3 c = Scale(hn::Mul(f_cos, light.Weight(l_pdf, pdf)), Mul(fresnel, light.Radiance(s, i)));
    StoreVec3(IfThenElseZero(lit, Mul(LoadVec3(s.beta_r, s.beta_g, s.beta_b, i), c)), s.c_r, s.c_g, s.c_b, i);
  }
}

// A direction chosen by one of the strategies, in the frame of the normal.
struct LobeSample {
  Vec3 wi;
  VF cos_h;   // between wo and the half vector; <= 0: the sample is void
  VF weight;  // f cos / pdf without Fresnel
  VF pdf;     // per steradian
};

HWY_INLINE SlopeView ViewSlopes(const Vec3& w, VF alpha) {
  return ViewSlopes(hn::Max(w.z, hn::Zero(DF())), hn::Sqrt(hn::MulAdd(w.x, w.x, hn::Mul(w.y, w.y))), alpha);
}

// Reflects wo about a microfacet chosen from the visible normals, or from all of them.
HWY_INLINE LobeSample SampleFacet(const CourseLobe& course, bool visible, const Vec3& wo, VF alpha, VF u, VF v) {
  const VF one = Splat(1.0f);
  const SlopeView view_o = ViewSlopes(wo, alpha);
  const VF sine = hn::Sqrt(hn::MulAdd(wo.x, wo.x, hn::Mul(wo.y, wo.y)));
  const FacetSlopes m = visible ? SampleVisibleNormal(view_o, wo, sine, alpha, u, v) : SampleNormal(alpha, u, v);
  const VF tan2 = hn::MulAdd(m.x, m.x, hn::Mul(m.y, m.y));
  const VF length2 = hn::Add(one, tan2);
  const VF wo_m = hn::MulAdd(wo.x, m.x, hn::MulAdd(wo.y, m.y, wo.z));  // wo.m / m_z
  const VF twice = hn::Div(hn::Add(wo_m, wo_m), length2);
  LobeSample sample;
  sample.wi = {hn::MulSub(twice, m.x, wo.x), hn::MulSub(twice, m.y, wo.y), hn::Sub(twice, wo.z)};
  sample.cos_h = hn::Min(hn::Div(wo_m, hn::Sqrt(length2)), one);
  const SlopeView view_i = ViewSlopes(sample.wi, alpha);
  const VF g1 = SmithG1(view_i);
  const VF distribution = BeckmannD(tan2, alpha);
  if (visible) {
    sample.weight = g1;
    sample.pdf = VisibleNormalPdf(distribution, view_o);
  } else {
    sample.weight = hn::Mul(hn::Mul(g1, SmithG1OverCos(view_o)), wo_m);
    sample.pdf = NormalPdf(distribution, wo_m);
  }
  if (course.any()) {
    sample.weight = hn::Div(CourseFCos(course, tan2, alpha, view_o, view_i), hn::Max(sample.pdf, Splat(1e-30f)));
  }
  return sample;
}

HWY_INLINE LobeSample SampleCosine(const CourseLobe& course, const Vec3& wo, VF alpha, VF u, VF v) {
  LobeSample sample;
  sample.wi = CosineHemisphere(u, v);
  const VF x = hn::Add(wo.x, sample.wi.x), y = hn::Add(wo.y, sample.wi.y);
  const HalfVector h = MakeHalfVector(hn::Add(wo.z, sample.wi.z), hn::MulAdd(x, x, hn::Mul(y, y)));
  sample.cos_h = h.cos;
  const SlopeView view_o = ViewSlopes(wo, alpha), view_i = ViewSlopes(sample.wi, alpha);
  const VF over_cos = hn::Mul(SmithG1OverCos(view_o), SmithG1OverCos(view_i));
  sample.weight = hn::Mul(hn::Mul(Splat(0.25f * kPi), BeckmannD(h.tan2, alpha)), over_cos);
  sample.pdf = hn::Mul(sample.wi.z, Splat(kInvPi));
  if (course.any()) {
    sample.weight = hn::Div(CourseFCos(course, h.tan2, alpha, view_o, view_i), hn::Max(sample.pdf, Splat(1e-30f)));
  }
  return sample;
}

void ShadeMicrofacet(const Plan& plan, const PathState& s, Range range) {
  const DF df;
  const VF zero = hn::Zero(df);
  const BsdfSampling strategy = plan.settings.bsdf_sampling;
  const CourseLobe course = plan.settings.course;
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(df)) {
    const Vec3 d = LoadVec3(s.d_x, s.d_y, s.d_z, i);
    const Vec3 normal = ViewerSide(LoadVec3(s.s_x, s.s_y, s.s_z, i), d);
    Vec3 b1, b2;
    Frame(normal, b1, b2);
    const Vec3 wo = {hn::Neg(Dot(d, b1)), hn::Neg(Dot(d, b2)), hn::Max(hn::Neg(Dot(d, normal)), zero)};
    const Metal metal(plan, s, i);
    const VF alpha = metal.alpha;
    const auto [u, v] = DrawFacet(plan, s, i);
    const LobeSample sample = strategy == BsdfSampling::kCosine
                                  ? SampleCosine(course, wo, alpha, u, v)
                                  : SampleFacet(course, strategy == BsdfSampling::kVndf, wo, alpha, u, v);

    const MF reflects = hn::And(hn::Gt(sample.wi.z, zero), hn::Gt(sample.cos_h, zero));
    const Vec3 wi = Normalize(ToWorld(sample.wi, b1, b2, normal));
    const Vec3 fresnel = FresnelConductor(plan.settings.fresnel, hn::Max(sample.cos_h, zero), metal.eta, metal.k);
    const Vec3 beta = Mul(LoadVec3(s.beta_r, s.beta_g, s.beta_b, i), Scale(sample.weight, fresnel));
    const Vec3 o =
        OffsetOrigin(LoadVec3(s.o_x, s.o_y, s.o_z, i), LoadVec3(s.n_x, s.n_y, s.n_z, i), hn::Load(df, s.err + i), wi);
    StoreVec3(IfThenElseZero(reflects, beta), s.beta_r, s.beta_g, s.beta_b, i);
    StoreVec3(o, s.o_x, s.o_y, s.o_z, i);
    StoreVec3(wi, s.d_x, s.d_y, s.d_z, i);
    hn::Store(hn::IfThenElseZero(reflects, sample.pdf), df, s.pdf + i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(LightMicrofacet, light_microfacet);
LANEWISE_KERNEL(ShadeMicrofacet, shade_microfacet);
}  // namespace lanewise
#endif
