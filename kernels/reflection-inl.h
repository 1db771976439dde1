// Where a point sees another reflected in a sphere: Alhazen's problem. Scalar twin: kernels/reference/reflection.h, which
// derives it.
#if defined(LANEWISE_KERNELS_REFLECTION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_REFLECTION_INL_H_
#undef LANEWISE_KERNELS_REFLECTION_INL_H_
#else
#define LANEWISE_KERNELS_REFLECTION_INL_H_
#endif

#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// x and y from the centre of a sphere, what lies between them, and the coefficients of the twin's equation. Its unknown is here
// v = tan(delta / 2) / sin(gamma / 2), so that nothing is divided by that sine:
//   q sin^4 v^4 - 2 (1 + p) sin^2 v^3 + 2 (1 - p) v - q = 0 with the sine left out of q.
struct Bisector {
  Vec3 sum, difference;  // of the unit vectors
  VF sum_length;
  VF sine2;   // sin^2(gamma / 2)
  VF closer;  // 1 / |y| - 1 / |x|
  VF p, q;

  HWY_INLINE Bisector(const Vec3& x, const Vec3& y, VF radius) {
    const VF quarter = Splat(0.25f), quarter_radius = hn::Mul(quarter, radius);
    const VF a = hn::Sqrt(Dot(x, x)), b = hn::Sqrt(Dot(y, y)), inv_ab = hn::Div(Splat(1.0f), hn::Mul(a, b));
    const VF inv_a = hn::Mul(b, inv_ab), inv_b = hn::Mul(a, inv_ab);
    const Vec3 x_unit = Scale(inv_a, x), y_unit = Scale(inv_b, y);
    sum = Add(x_unit, y_unit), difference = Sub(y_unit, x_unit);
    sum_length = hn::Max(hn::Sqrt(Dot(sum, sum)), Splat(1e-18f));
    sine2 = hn::Mul(quarter, Dot(difference, difference));
    closer = hn::Sub(inv_b, inv_a);
    p = hn::Mul(quarter_radius, hn::Mul(hn::Add(inv_a, inv_b), sum_length));
    q = hn::Mul(hn::Add(quarter_radius, quarter_radius), hn::Abs(closer));
  }
};

// The root v. It begins from the equation's first and third powers; Newton's method with the second derivative follows, that is,
// the nearer root of the parabola that touches. Two steps are right to all bits where neither x nor y is near the sphere; lanes
// that still move take a third, which is right to 6e-6 of itself everywhere.
HWY_INLINE VF HalfTilt(const Bisector& between) {
  const DF d;
  const VF zero = hn::Zero(d), half = Splat(0.5f), one = Splat(1.0f), three = Splat(3.0f);
  const VF minus = hn::Sub(one, between.p), inv_minus = hn::Div(one, minus);
  const VF cubic = hn::Mul(hn::Add(one, between.p), between.sine2), half_q = hn::Mul(half, between.q);
  const VF quartic = hn::Mul(half_q, hn::Mul(between.sine2, between.sine2));
  const auto step = [&](VF v) HWY_ATTR {
    const VF v2 = hn::Mul(v, v), cubic_v2 = hn::Mul(cubic, v2), quartic_v2 = hn::Mul(quartic, v2);
    // Half of the function and of its derivative; of the second derivative a twelfth.
    const VF f = hn::MulAdd(v, hn::Sub(minus, cubic_v2), hn::MulSub(v2, quartic_v2, half_q));
    const VF f1 = hn::MulAdd(hn::Mul(Splat(4.0f), quartic_v2), v, hn::NegMulAdd(three, cubic_v2, minus));
    const VF f2 = hn::NegMulAdd(cubic, v, hn::Add(quartic_v2, quartic_v2));
    const VF root = hn::Sqrt(hn::Max(hn::MulSub(f1, f1, hn::Mul(Splat(12.0f), hn::Mul(f, f2))), zero));
    return hn::Div(hn::Add(f, f), hn::Add(f1, root));
  };
  VF v = hn::Mul(half_q, inv_minus);
  v = hn::MulAdd(v, hn::Mul(hn::Mul(v, v), hn::Mul(cubic, inv_minus)), v);
  v = hn::Sub(v, step(v));
  const VF second = step(v);
  v = hn::Sub(v, second);
  const MF moves = hn::Gt(hn::Abs(second), hn::Mul(Splat(0.003f), v));
  if (!hn::AllFalse(d, moves)) v = hn::IfThenElse(moves, hn::Sub(v, step(v)), v);
  return v;
}

struct SphereReflection {
  MF exists;
  Vec3 n;       // unit normal of the sphere at the point of reflection
  Vec3 to_y;    // from there to y
  VF distance;  // its length
  VF height;    // (x + y - 2 p).n with p that point: cosine of incidence times whole
  VF whole;     // length of the way from x to y
  VF spread;    // area across the ray at y per steradian at x, times height
};

// Where nothing is reflected, all but `exists` is anything.
HWY_INLINE SphereReflection ReflectInSphere(const Bisector& between, VF v, const Vec3& x, const Vec3& y, VF radius,
                                            VF inv_radius) {
  const VF zero = hn::Zero(DF()), one = Splat(1.0f);
  const VF t2 = hn::Mul(between.sine2, hn::Mul(v, v));
  const VF inv = hn::Div(one, hn::Mul(hn::Add(one, t2), between.sum_length));
  const VF along = hn::Mul(hn::Sub(one, t2), inv), across = hn::Mul(hn::Mul(v, between.sum_length), inv);
  SphereReflection out;
  out.n = MulAdd(along, between.sum, Scale(hn::CopySign(across, between.closer), between.difference));
  const Vec3 to_x = MulAdd(hn::Neg(radius), out.n, x);
  out.to_y = MulAdd(hn::Neg(radius), out.n, y);
  const VF x_height = Dot(to_x, out.n), y_height = Dot(out.to_y, out.n);
  out.exists = hn::And(hn::Gt(x_height, zero), hn::Gt(y_height, zero));
  const VF x_distance = hn::Sqrt(Dot(to_x, to_x));
  out.distance = hn::Sqrt(Dot(out.to_y, out.to_y));
  out.height = hn::Add(x_height, y_height);
  out.whole = hn::Add(x_distance, out.distance);
  const VF product = hn::Mul(x_distance, out.distance), curved = hn::Mul(hn::Add(product, product), inv_radius);
  // The twin's, with height / whole for the cosine.
  out.spread = hn::Mul(hn::MulAdd(curved, out.height, hn::Mul(out.whole, out.whole)), hn::Add(out.height, curved));
  return out;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
