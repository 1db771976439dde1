#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/shade_diffuse.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/rng-inl.h"
#include "kernels/sampling-inl.h"
#include "kernels/shading-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// Where the albedo comes from.
struct OfMaterial {
  HWY_INLINE Vec3 operator()(const Plan& plan, const PathState& s, size_t i) const {
    return LaneMaterials(plan, s, i).GetVec3(kReflectance);
  }
};
struct OfTexture {
  HWY_INLINE Vec3 operator()(const Plan&, const PathState& s, size_t i) const {
    return LoadVec3(s.a_r, s.a_g, s.a_b, i);
  }
};

template <class Albedo>
HWY_INLINE void LightLambertian(const Plan& plan, const PathState& s, Range range, Albedo albedo_of) {
  const DF d;
  const LightTerms light(plan, s.step);
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const Vec3 normal = ViewerSide(LoadVec3(s.s_x, s.s_y, s.s_z, i), LoadVec3(s.d_x, s.d_y, s.d_z, i));
    const Vec3 l = LoadVec3(s.l_x, s.l_y, s.l_z, i);
    const VF l_pdf = hn::Load(d, s.l_pdf + i);
    const VF cosine = hn::Div(Dot(l, normal), hn::Sqrt(Dot(l, l)));
    const VF pdf = hn::Mul(cosine, Splat(kInvPi));
    const MF lit = hn::And(hn::Gt(cosine, hn::Zero(d)), hn::Gt(l_pdf, hn::Zero(d)));
    // f cos = albedo pdf.
    const Vec3 albedo = albedo_of(plan, s, i);
    const Vec3 c = Scale(hn::Mul(pdf, light.Weight(l_pdf, pdf)), Mul(albedo, light.Radiance(s, i)));
    StoreVec3(IfThenElseZero(lit, Mul(LoadVec3(s.beta_r, s.beta_g, s.beta_b, i), c)), s.c_r, s.c_g, s.c_b, i);
  }
}

template <class Albedo>
HWY_INLINE void ShadeLambertian(const Plan& plan, const PathState& s, Range range, Albedo albedo_of) {
  const DF d;
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const Vec3 normal = ViewerSide(LoadVec3(s.s_x, s.s_y, s.s_z, i), LoadVec3(s.d_x, s.d_y, s.d_z, i));
    const Random4 random = DrawDirection(plan, s, i);
    const Vec3 local = CosineHemisphere(random.u[kDrawU], random.u[kDrawV]);
    Vec3 b1, b2;
    Frame(normal, b1, b2);
    const Vec3 wi = ToWorld(local, b1, b2, normal);
    const Vec3 o =
        OffsetOrigin(LoadVec3(s.o_x, s.o_y, s.o_z, i), LoadVec3(s.n_x, s.n_y, s.n_z, i), hn::Load(d, s.err + i), wi);
    const Vec3 albedo = albedo_of(plan, s, i);
    StoreVec3(Mul(LoadVec3(s.beta_r, s.beta_g, s.beta_b, i), albedo), s.beta_r, s.beta_g, s.beta_b, i);
    StoreVec3(o, s.o_x, s.o_y, s.o_z, i);
    StoreVec3(wi, s.d_x, s.d_y, s.d_z, i);
    hn::Store(hn::Mul(local.z, Splat(kInvPi)), d, s.pdf + i);
  }
}

void LightDiffuse(const Plan& plan, const PathState& s, Range range) { LightLambertian(plan, s, range, OfMaterial()); }
void LightTextured(const Plan& plan, const PathState& s, Range range) { LightLambertian(plan, s, range, OfTexture()); }
void ShadeDiffuse(const Plan& plan, const PathState& s, Range range) { ShadeLambertian(plan, s, range, OfMaterial()); }
void ShadeTextured(const Plan& plan, const PathState& s, Range range) { ShadeLambertian(plan, s, range, OfTexture()); }

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(LightDiffuse, light_diffuse);
LANEWISE_KERNEL(LightTextured, light_textured);
LANEWISE_KERNEL(ShadeDiffuse, shade_diffuse);
LANEWISE_KERNEL(ShadeTextured, shade_textured);
}  // namespace lanewise
#endif
