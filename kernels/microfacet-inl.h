// Beckmann microfacets: distribution, Smith's shadowing, sampling. Directions are given by their components in the
// frame of the shading normal. All is computed from tangents of the half vector, the only form that holds for small
// alpha: the cosine alone has lost them. Scalar twin: kernels/reference/microfacet.h. Walter et al., Microfacet Models
// for Refraction through Rough Surfaces, EGSR 2007; Heitz & d'Eon, Importance Sampling Microfacet-Based BSDFs using the
// Distribution of Visible Normals, EGSR 2014.
#if defined(LANEWISE_KERNELS_MICROFACET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_MICROFACET_INL_H_
#undef LANEWISE_KERNELS_MICROFACET_INL_H_
#else
#define LANEWISE_KERNELS_MICROFACET_INL_H_
#endif

#include "core/settings.h"
#include "kernels/math-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// Narrower lobes than this are narrower than a float direction's rounding: they are mirrors, and look it. It also keeps
// every density finite, with its square.
constexpr float kMinAlpha = 1e-6f;

// D(m), per steradian, from tan2 = tan^2 of m's angle to the normal.
HWY_INLINE VF BeckmannD(VF tan2, VF alpha) {
  const VF q = hn::Div(hn::Add(Splat(1.0f), tan2), alpha);
  const VF slope = hn::Div(tan2, hn::Mul(alpha, alpha));
  return hn::Mul(hn::Mul(Exp(hn::Neg(slope)), Splat(0.318309886183791f)), hn::Mul(q, q));
}

// How the unit-roughness surface is seen from a direction that the stretch by alpha took to cosine c and sine s (not
// normalised): its visible slopes x, measured away from the viewer, have density max(0, c - x s) e^(-x^2) / area.
struct SlopeView {
  VF c, s;
  VF half;    // sqrt(pi) / 2 c
  VF cut;     // c / s, above which slopes face away; or 10, where e^(-x^2) is nothing
  VF cut_e;   // e^(-cut^2)
  VF cut_ec;  // erfc(cut)
  VF area;    // integral of max(0, c - x s) e^(-x^2) over x
};

// cosine >= 0 and sine >= 0 of the direction's angle to the normal.
HWY_INLINE SlopeView ViewSlopes(VF cosine, VF sine, VF alpha) {
  SlopeView v;
  v.c = cosine;
  v.s = hn::Max(hn::Mul(alpha, sine), Splat(1e-20f));
  v.half = hn::Mul(Splat(0.886226925452758f), v.c);
  v.cut = hn::Min(hn::Div(v.c, v.s), Splat(10.0f));
  v.cut_e = Exp(hn::Neg(hn::Mul(v.cut, v.cut)));
  v.cut_ec = hn::Mul(Erfcx(v.cut), v.cut_e);
  v.area = hn::MulAdd(v.half, hn::Sub(Splat(2.0f), v.cut_ec), hn::Mul(hn::Mul(Splat(0.5f), v.s), v.cut_e));
  return v;
}

// Smith's G1 = 1 / (1 + Lambda) with the exact Lambda of Beckmann, as a sum of positive terms; absolute error < 1e-6.
HWY_INLINE VF SmithG1(const SlopeView& v) { return hn::Div(hn::Add(v.half, v.half), v.area); }
// G1 / cosine, finite at grazing angles.
HWY_INLINE VF SmithG1OverCos(const SlopeView& v) { return hn::Div(Splat(1.77245385090552f), v.area); }

// The tangent's square where the cosine is 1 - 1e-5.
constexpr float kCourseTan2 = 2.00003e-5f;

// G of the course program: 1 / (1 + Lambda(wo) + Lambda(wi)) with Lambda(a) = (e^(-a^2) / (pi a) - erfc(a)) / 2, a = c / s. It
// exceeds 1, by up to 5%, where Lambda is negative.
HWY_INLINE VF CourseLambda(const SlopeView& v) {
  return hn::Mul(Splat(0.5f), hn::MulSub(Splat(0.318309886183791f), hn::Div(v.cut_e, v.cut), v.cut_ec));
}
HWY_INLINE VF CourseG(const SlopeView& wo, const SlopeView& wi) {
  const VF one = Splat(1.0f);
  return hn::Div(one, hn::Add(one, hn::Add(CourseLambda(wo), CourseLambda(wi))));
}

// f cos without Fresnel, D G / (4 cos_o), as the course program departs from it.
HWY_INLINE VF CourseFCos(const CourseLobe& course, VF tan2, VF alpha, const SlopeView& wo, const SlopeView& wi) {
  const VF d = BeckmannD(course.clamp ? hn::Max(tan2, Splat(kCourseTan2)) : tan2, alpha);
  const VF g_over_cos =
      course.masking ? hn::Div(CourseG(wo, wi), hn::Max(wo.c, Splat(1e-6f))) : hn::Mul(SmithG1OverCos(wo), SmithG1(wi));
  return hn::Mul(hn::Mul(Splat(0.25f), d), g_over_cos);
}

// u in [0, 1) to a slope x of the view's density: the root of P(x) = u by three Halley steps. Where P(0) > u the root
// is sought for the lower tail, elsewhere for the upper one, so that neither tail is lost in the other's rounding; both
// are
//   half erfc(z) + sigma / 2 e^(-z^2) = target  with z = |x|, sigma = s below and -s above.
// Error of P(x): < 1e-6 absolute, for every angle.
HWY_INLINE VF SampleVisibleSlope(const SlopeView& v, VF uniform) {
  const VF zero = hn::Zero(DF()), one = Splat(1.0f), half = Splat(0.5f);
  const VF u = hn::Max(uniform, Splat(0x1p-25f));
  const VF below = hn::MulAdd(half, v.s, v.half);  // area P(0)
  const VF lower_mass = hn::Mul(u, v.area);
  const MF lower = hn::Le(lower_mass, below);
  const VF mass = hn::IfThenElse(lower, lower_mass, hn::Mul(hn::Sub(one, u), v.area));
  // What the upper tail's formula yields at the cut, where the tail is empty.
  const VF floor = hn::NegMulAdd(hn::Mul(half, v.s), v.cut_e, hn::Mul(v.half, v.cut_ec));
  const VF target = hn::IfThenElse(lower, lower_mass, hn::Add(mass, floor));
  const VF sigma = hn::IfThenElse(lower, v.s, hn::Neg(v.s));
  const VF limit = hn::IfThenElse(lower, Splat(5.0f), v.cut);

  // First guess, from the tail's share: z^2 + 2 b z = ln(1 / share) is exact for grazing views and in slope at z = 0.
  // In the upper tail it is bent to stay below the cut, and the parabola through the cut bounds it from below.
  const VF whole =
      hn::IfThenElse(lower, below, hn::Max(hn::Sub(hn::NegMulAdd(half, v.s, v.half), floor), Splat(1e-30f)));
  const VF log_share = hn::Neg(Log(Clamp(hn::Div(mass, whole), 1e-12f, 1.0f)));
  const VF b = hn::Div(hn::Mul(half, v.c), whole);
  VF z = hn::Div(log_share, hn::Max(hn::Add(hn::Sqrt(hn::MulAdd(b, b, log_share)), b), Splat(1e-30f)));
  const VF over = hn::Sub(z, v.cut);
  const VF bend = hn::Mul(Splat(0.25f), hn::Min(one, hn::Mul(v.cut, v.cut)));
  const VF bent = hn::Mul(half, hn::Sub(hn::Add(z, v.cut), hn::Sqrt(hn::MulAdd(over, over, bend))));
  const VF parabola = hn::Sub(v.cut, hn::Sqrt(hn::Div(hn::Add(mass, mass), hn::Mul(v.s, v.cut_e))));
  z = hn::IfThenElse(lower, z, hn::Max(bent, parabola));
  z = hn::Min(hn::Max(z, zero), limit);

  for (int step = 0; step < 3; ++step) {
    const VF e = Exp(hn::Neg(hn::Mul(z, z)));
    const VF value = hn::Mul(e, hn::MulAdd(v.half, Erfcx(z), hn::Mul(half, sigma)));
    const VF slope = hn::Max(hn::MulAdd(z, sigma, v.c), Splat(1e-20f));  // of value, over -e
    const VF newton = hn::Div(hn::Sub(value, target), hn::Mul(slope, e));
    const VF bow = hn::NegMulAdd(Splat(2.0f), z, hn::Div(sigma, slope));  // second derivative over first
    const VF halley = hn::Div(newton, hn::Max(hn::MulAdd(hn::Mul(half, newton), bow, one), half));
    z = hn::Min(hn::Max(hn::Add(z, halley), zero), limit);
  }
  return hn::IfThenElse(lower, hn::Neg(z), z);
}

// A microfacet normal in the frame of the shading normal, by its slopes: m = (x, y, 1) / sqrt(1 + x^2 + y^2).
struct FacetSlopes {
  VF x, y;
};

// u, v in [0, 1) to normals of density D(m) m_z.
HWY_INLINE FacetSlopes SampleNormal(VF alpha, VF u, VF v) {
  VF sin, cos;
  SinCos2Pi(v, sin, cos);
  const VF r = hn::Mul(alpha, hn::Sqrt(hn::Neg(Log(hn::Sub(Splat(1.0f), u)))));
  return {hn::Mul(r, cos), hn::Mul(r, sin)};
}

// u, v in [0, 1) to normals of density G1(wo) max(0, wo.m) D(m) / wo.z. Below a sine of 1e-5 the view has no azimuth to
// speak of, and the distribution no use for one.
HWY_INLINE FacetSlopes SampleVisibleNormal(const SlopeView& view, const Vec3& wo, VF sine, VF alpha, VF u, VF v) {
  const MF tilted = hn::Gt(sine, Splat(1e-5f));
  const VF along = hn::Neg(SampleVisibleSlope(view, u));
  const VF across = ErfInvCentered(hn::Max(v, Splat(0x1p-25f)));
  const VF safe = hn::Max(sine, Splat(1e-5f));
  const VF cos = hn::IfThenElse(tilted, hn::Div(wo.x, safe), Splat(1.0f));
  const VF sin = hn::IfThenElseZero(tilted, hn::Div(wo.y, safe));
  return {hn::Mul(alpha, hn::MulSub(cos, along, hn::Mul(sin, across))),
          hn::Mul(alpha, hn::MulAdd(sin, along, hn::Mul(cos, across)))};
}

// The sum of two unit vectors above the surface, by its part along the normal and its squared part across.
struct HalfVector {
  VF tan2;     // tan^2 of its angle to the normal
  VF z;        // its part along the normal, not normalised
  VF length2;  // its squared length
  VF cos;      // of the angle between it and either of the two
};

HWY_INLINE HalfVector MakeHalfVector(VF along, VF across2) {
  HalfVector h;
  // The bounds matter only where D is 0 and keep 0 * inf away.
  h.z = hn::Max(along, Splat(1e-6f));
  h.length2 = hn::MulAdd(h.z, h.z, across2);
  h.tan2 = hn::Div(across2, hn::Mul(h.z, h.z));
  h.cos = hn::Min(hn::Mul(Splat(0.5f), hn::Sqrt(h.length2)), Splat(1.0f));
  return h;
}

// Densities per steradian of the reflected direction, by the way the microfacet's normal is chosen: as visible from wo,
// or from D alone. wo_m: wo.m / m_z > 0.
HWY_INLINE VF VisibleNormalPdf(VF d, const SlopeView& wo) {
  return hn::Mul(hn::Mul(Splat(0.25f), d), SmithG1OverCos(wo));
}
HWY_INLINE VF NormalPdf(VF d, VF wo_m) { return hn::Div(hn::Mul(Splat(0.25f), d), hn::Max(wo_m, Splat(1e-6f))); }

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
