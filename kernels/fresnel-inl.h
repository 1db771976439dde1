// Fresnel reflectance of dielectrics and conductors, in forms without cancellation. Scalar twin:
// kernels/reference/fresnel.h, which derives them.
#if defined(LANEWISE_KERNELS_FRESNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_FRESNEL_INL_H_
#undef LANEWISE_KERNELS_FRESNEL_INL_H_
#else
#define LANEWISE_KERNELS_FRESNEL_INL_H_
#endif

#include "core/settings.h"
#include "kernels/math-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

HWY_INLINE VF Square(VF x) { return hn::Mul(x, x); }

// (1 - c)^5 (1 - f0) + f0.
HWY_INLINE VF SchlickFresnel(VF f0, VF c) {
  const VF one = Splat(1.0f);
  const VF m = hn::Sub(one, c);
  return hn::MulAdd(hn::Mul(Square(Square(m)), m), hn::Sub(one, f0), f0);
}

// What light does at a smooth boundary between indices n_i (its own side) and n_t.
struct Dielectric {
  VF reflectance;    // in [0, 1]; exactly 1 under total internal reflection
  VF transmittance;  // 1 - reflectance, of the exact formulas without cancellation
  VF cos_t;          // of the refracted direction against the normal; 0 under total internal reflection
};

// c: cosine of incidence in [0, 1]. kSchlick takes the transmitted cosine from the dense side; kCourse, like the course
// program, always the incident one.
HWY_INLINE Dielectric FresnelDielectric(Fresnel model, VF c, VF n_i, VF n_t) {
  const DF d;
  const VF zero = hn::Zero(d), one = Splat(1.0f);
  const VF n_i2 = Square(n_i), n_t2 = Square(n_t);
  const VF e = hn::Mul(hn::Sub(n_t, n_i), hn::Add(n_t, n_i));
  // (n_t cos_t)^2 = n_t^2 - n_i^2 + (n_i c)^2; at or below 0 nothing is refracted.
  const VF n_c = hn::Mul(n_i, c);
  const VF g2 = hn::MulAdd(n_c, n_c, e);
  const MF refracts = hn::Gt(g2, zero);
  const VF g = hn::Sqrt(hn::Max(g2, zero));
  const VF cos_t = hn::Min(hn::Div(g, n_t), one);
  VF reflectance, transmittance;
  if (model == Fresnel::kExact) {
    const VF c2 = Square(c);
    const VF s2 = Square(hn::Add(n_c, g)), p2 = Square(hn::MulAdd(n_t2, c, hn::Mul(n_i, g)));
    const VF rs = hn::Div(e, s2);
    const VF rp = hn::Div(hn::Mul(e, hn::MulSub(hn::Add(n_t2, n_i2), c2, n_i2)), p2);
    transmittance =
        hn::Mul(hn::Mul(Splat(2.0f), hn::Mul(n_c, g)), hn::Add(hn::Div(Splat(1.0f), s2), hn::Div(n_t2, p2)));
    reflectance = hn::Min(hn::Mul(Splat(0.5f), hn::MulAdd(rs, rs, Square(rp))), one);
  } else {
    const VF f0 = Square(hn::Div(hn::Sub(n_i, n_t), hn::Add(n_i, n_t)));
    const MF dense = hn::Gt(n_i, n_t);
    const VF cosine = model == Fresnel::kSchlick ? hn::IfThenElse(dense, cos_t, c) : c;
    reflectance = SchlickFresnel(f0, cosine);
    transmittance = hn::Sub(one, reflectance);
  }
  return {hn::IfThenElse(refracts, reflectance, one), hn::IfThenElseZero(refracts, transmittance),
          hn::IfThenElseZero(refracts, cos_t)};
}

// One channel of a conductor with complex index eta + i k against vacuum, c in [0, 1] the cosine of incidence.
HWY_INLINE VF FresnelConductor(Fresnel model, VF c, VF eta, VF k) {
  const VF one = Splat(1.0f), two = Splat(2.0f);
  const VF c2 = Square(c);
  if (model == Fresnel::kExact) {
    const VF s2 = hn::Sub(one, c2);
    // a + i b = sqrt((eta + i k)^2 - s2): the larger part by the sum, the smaller by the product a b = eta k.
    const VF ab = hn::Mul(eta, k);
    const VF ab2 = hn::Mul(ab, ab);
    // eta^2 - k^2 - s^2, in factors that keep small differences of near-vacuum indices.
    const VF t0 = hn::MulAdd(hn::Sub(eta, one), hn::Add(eta, one), hn::Mul(hn::Sub(c, k), hn::Add(c, k)));
    const VF modulus = hn::Sqrt(hn::MulAdd(t0, t0, hn::Mul(Splat(4.0f), ab2)));
    const VF larger = hn::Mul(Splat(0.5f), hn::Add(modulus, hn::Abs(t0)));
    const VF smaller = hn::Div(ab2, hn::Max(larger, Splat(1e-30f)));
    const MF positive = hn::Ge(t0, hn::Zero(DF()));
    const VF a2 = hn::IfThenElse(positive, larger, smaller);
    const VF b2 = hn::IfThenElse(positive, smaller, larger);
    const VF a = hn::Sqrt(a2);
    // F = (Rs + Rp) / 2 = Rs (c^2 |a + i b|^2 + s^4) / ((a c + s^2)^2 + (b c)^2). The little that is added keeps 0 / 0,
    // met only by indices that are 0 or those of vacuum, at 1.
    const VF little = Splat(1e-18f);
    const VF rs_top = hn::Add(hn::Add(Square(hn::Sub(a, c)), b2), little);
    const VF rs_bottom = hn::Add(hn::Add(Square(hn::Add(a, c)), b2), little);
    const VF top = hn::Add(hn::MulAdd(c2, hn::Add(a2, b2), Square(s2)), little);
    const VF bottom = hn::Add(hn::MulAdd(c2, b2, Square(hn::MulAdd(a, c, s2))), little);
    return hn::Min(hn::Div(hn::Mul(rs_top, top), hn::Mul(rs_bottom, bottom)), one);
  }
  const VF k2 = hn::Mul(k, k);
  if (model == Fresnel::kSchlick) {
    const VF f0 = hn::Div(hn::MulAdd(hn::Sub(eta, one), hn::Sub(eta, one), k2),
                          hn::MulAdd(hn::Add(eta, one), hn::Add(eta, one), k2));
    return SchlickFresnel(f0, c);
  }
  const VF m2 = hn::MulAdd(eta, eta, k2);
  const VF cross = hn::Mul(two, hn::Mul(eta, c));
  const VF s_sum = hn::Add(m2, c2), p_sum = hn::MulAdd(m2, c2, one);
  const VF rs = hn::Div(hn::Sub(s_sum, cross), hn::Max(hn::Add(s_sum, cross), Splat(1e-30f)));
  const VF rp = hn::Div(hn::Sub(p_sum, cross), hn::Add(p_sum, cross));
  return Clamp(hn::Mul(Splat(0.5f), hn::Add(rs, rp)), 0.0f, 1.0f);
}

HWY_INLINE Vec3 FresnelConductor(Fresnel model, VF c, const Vec3& eta, const Vec3& k) {
  return {FresnelConductor(model, c, eta.x, k.x), FresnelConductor(model, c, eta.y, k.y),
          FresnelConductor(model, c, eta.z, k.z)};
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
