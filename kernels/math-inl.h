// Elementary functions in float. The order of operations is fixed and has no width in it, so targets with the same
// arithmetic (AVX2 and AVX-512 fuse, SSE4 and scalar do not) give the same bits. The polynomials are minimax fits in
// relative error (Lawson's weights), their coefficients rounded one after the other with the rest fitted again. The largest
// errors are stated in kernels/functions.h and measured on every float of the domains: perf/results/functions.md.
#if defined(LANEWISE_KERNELS_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_MATH_INL_H_
#undef LANEWISE_KERNELS_MATH_INL_H_
#else
#define LANEWISE_KERNELS_MATH_INL_H_
#endif

#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

HWY_INLINE VF Clamp(VF x, float lo, float hi) { return hn::Min(hn::Max(x, Splat(lo)), Splat(hi)); }

// sin(2 pi u) and cos(2 pi u) for u in [0, 1], good also beside their zeros.
HWY_INLINE void SinCos2Pi(VF u, VF& sin, VF& cos) {
  const DF d;
  const DI di;
  // The quadrant and the way into it are exact: |r| <= 1/2, the angle is pi / 2 (quadrant + r).
  const VF turned = hn::Mul(u, Splat(4.0f));
  const VI quadrant = hn::NearestInt(turned);
  const VF r = hn::Sub(turned, hn::ConvertTo(d, quadrant));
  const VF r2 = hn::Mul(r, r);
  VF s = hn::MulAdd(r2, Splat(-0.0046859714f), Splat(0.079712525f));
  s = hn::MulAdd(r2, s, Splat(-0.64596665f));
  s = hn::Mul(r, hn::MulAdd(r2, s, Splat(1.5707964f)));
  VF c = hn::MulAdd(r2, Splat(0.0008944606f), Splat(-0.020855593f));
  c = hn::MulAdd(r2, c, Splat(0.25366855f));
  c = hn::MulAdd(r2, c, Splat(-1.2337005f));
  c = hn::MulAdd(r2, c, Splat(1.0f));
  const VI one = hn::Set(di, 1);
  const MF swap = hn::RebindMask(d, hn::Eq(hn::And(quadrant, one), one));
  const VF sin_sign = hn::BitCast(d, hn::ShiftLeft<30>(hn::And(quadrant, hn::Set(di, 2))));
  const VF cos_sign = hn::BitCast(d, hn::ShiftLeft<30>(hn::And(hn::Add(quadrant, one), hn::Set(di, 2))));
  sin = hn::Xor(hn::IfThenElse(swap, c, s), sin_sign);
  cos = hn::Xor(hn::IfThenElse(swap, s, c), cos_sign);
}

// atan(t) / (2 pi) for |t| <= tan(pi / 8).
HWY_INLINE VF AtanTurns(VF t) {
  const VF t2 = hn::Mul(t, t);
  VF p = hn::MulAdd(t2, Splat(0.011967405f), Splat(-0.021804143f));
  p = hn::MulAdd(t2, p, Splat(0.03176614f));
  p = hn::MulAdd(t2, p, Splat(-0.05305004f));
  return hn::Mul(t, hn::MulAdd(t2, p, Splat(0.15915494f)));
}

// The angle of (x, y) in turns, in [-1/2, 1/2], good to 3 ulp also beside its zeros; 0 or 1/2 for (0, 0). y's sign, also of a
// zero, is the angle's. Neither may be NaN or infinite.
HWY_INLINE VF Atan2Turns(VF y, VF x) {
  const VF ax = hn::Abs(x), ay = hn::Abs(y);
  const VF least = hn::Min(ax, ay), most = hn::Max(ax, ay);
  // Beyond tan(pi / 8) from 1/8 turn on.
  const MF beyond = hn::Gt(least, hn::Mul(most, Splat(0.41421357f)));
  const VF opposite = hn::IfThenElse(beyond, hn::Sub(least, most), least);
  const VF adjacent = hn::IfThenElse(beyond, hn::Add(least, most), hn::Max(most, Splat(0x1p-126f)));
  VF turns = AtanTurns(hn::Div(opposite, adjacent));
  turns = hn::Add(turns, hn::IfThenElseZero(beyond, Splat(0.125f)));
  turns = hn::IfThenElse(hn::Gt(ay, ax), hn::Sub(Splat(0.25f), turns), turns);
  turns = hn::IfThenElse(hn::Lt(x, hn::Zero(DF())), hn::Sub(Splat(0.5f), turns), turns);
  return hn::CopySign(turns, y);
}

// e^x for x <= 88, -inf included; 0 below -87.3365, where e^x comes to the smallest normal float.
HWY_INLINE VF Exp(VF x) {
  const DF d;
  const VF kept = hn::Max(x, Splat(-87.3365f));
  const VI n = hn::NearestInt(hn::Mul(kept, Splat(1.44269504f)));
  const VF whole = hn::ConvertTo(d, n);
  // ln 2 in two parts; the first has few bits, so its product is exact.
  const VF r = hn::NegMulAdd(whole, Splat(-2.12194440e-4f), hn::NegMulAdd(whole, Splat(0.693359375f), kept));
  VF p = hn::MulAdd(r, Splat(0.0013820136f), Splat(0.008368686f));
  p = hn::MulAdd(r, p, Splat(0.041668274f));
  p = hn::MulAdd(r, p, Splat(0.16666521f));
  p = hn::MulAdd(r, p, Splat(0.49999994f));
  const VF fraction = hn::Add(Splat(1.0f), hn::MulAdd(hn::Mul(r, r), p, r));
  const VF power = hn::BitCast(d, hn::ShiftLeft<23>(hn::Add(n, hn::Set(DI(), 127))));
  return hn::IfThenElseZero(hn::Ge(x, Splat(-87.3365f)), hn::Mul(fraction, power));
}

// ln x for normal x > 0, good also beside x = 1.
HWY_INLINE VF Log(VF x) {
  const DF d;
  const DI di;
  const VI bits = hn::BitCast(di, x);
  // x = 2^e m with m in [sqrt(1/2), sqrt(2)).
  const VI e = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(di, 0x3F3504F3)));
  const VF f = hn::Sub(hn::BitCast(d, hn::Sub(bits, hn::ShiftLeft<23>(e))), Splat(1.0f));
  VF p = hn::MulAdd(f, Splat(-0.07636439f), Splat(0.12762217f));
  p = hn::MulAdd(f, p, Splat(-0.1315961f));
  p = hn::MulAdd(f, p, Splat(0.1420158f));
  p = hn::MulAdd(f, p, Splat(-0.16623409f));
  p = hn::MulAdd(f, p, Splat(0.20001242f));
  p = hn::MulAdd(f, p, Splat(-0.2500082f));
  p = hn::MulAdd(f, p, Splat(0.3333333f));
  const VF f2 = hn::Mul(f, f);
  const VF whole = hn::ConvertTo(d, e);
  VF tail = hn::MulAdd(whole, Splat(-2.12194440e-4f), hn::Mul(hn::Mul(f2, f), p));
  tail = hn::NegMulAdd(Splat(0.5f), f2, tail);
  return hn::MulAdd(whole, Splat(0.693359375f), hn::Add(f, tail));
}

// e^(x^2) erfc(x) for x in [0, 10]. erfc(x) is this times Exp(-x^2), with no cancellation anywhere.
HWY_INLINE VF Erfcx(VF x) {
  const VF t = hn::Div(Splat(1.0f), hn::MulAdd(Splat(0.4f), x, Splat(1.0f)));
  VF p = hn::MulAdd(t, Splat(-0.029593058f), Splat(0.1980063f));
  p = hn::MulAdd(t, p, Splat(-0.4987954f));
  p = hn::MulAdd(t, p, Splat(0.54741424f));
  p = hn::MulAdd(t, p, Splat(-0.28434932f));
  p = hn::MulAdd(t, p, Splat(0.27205706f));
  p = hn::MulAdd(t, p, Splat(0.12968273f));
  p = hn::MulAdd(t, p, Splat(0.21491843f));
  p = hn::MulAdd(t, p, Splat(0.2249521f));
  p = hn::MulAdd(t, p, Splat(0.2257069f));
  return hn::Mul(t, p);
}

// erf^-1(2 u - 1) for u in [2^-25, 1): maps a uniform number to one of density e^(-y^2) / sqrt(pi).
// Two polynomials in w = -ln(4 u (1 - u)) as in Giles, Approximating the erfinv function, GPU Computing Gems 2, 2011.
HWY_INLINE VF ErfInvCentered(VF u) {
  const VF w = hn::Neg(Log(hn::Mul(hn::Mul(Splat(4.0f), u), hn::Sub(Splat(1.0f), u))));
  const MF far = hn::Gt(w, Splat(5.0f));
  const VF t = hn::IfThenElse(far, hn::Sub(hn::Sqrt(hn::Max(w, hn::Zero(DF()))), Splat(3.0f)), hn::Sub(w, Splat(2.5f)));
  const auto pick = [&](float of_far, float of_near)
                        HWY_ATTR { return hn::IfThenElse(far, Splat(of_far), Splat(of_near)); };
  VF p = hn::MulAdd(t, pick(-0.00019526396f, 2.849635e-08f), pick(9.7232805e-05f, 3.4403797e-07f));
  p = hn::MulAdd(t, p, pick(0.0013469523f, -3.5280523e-06f));
  p = hn::MulAdd(t, p, pick(-0.0036702468f, -4.4005164e-06f));
  p = hn::MulAdd(t, p, pick(0.005737479f, 0.00021859669f));
  p = hn::MulAdd(t, p, pick(-0.0076232688f, -0.001253694f));
  p = hn::MulAdd(t, p, pick(0.009440029f, -0.0041776937f));
  p = hn::MulAdd(t, p, pick(1.0016742f, 0.24664071f));
  p = hn::MulAdd(t, p, pick(2.8329768f, 1.5014094f));
  return hn::Mul(hn::Sub(hn::Add(u, u), Splat(1.0f)), p);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
