// One sphere test for the flat list and the tree's leaves: Haines, Guenther & Akenine-Moeller, Precision Improvements
// for Ray/Sphere Intersection, Ray Tracing Gems ch. 7, for directions of any length.
#if defined(LANEWISE_KERNELS_SPHERE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_SPHERE_INL_H_
#undef LANEWISE_KERNELS_SPHERE_INL_H_
#else
#define LANEWISE_KERNELS_SPHERE_INL_H_
#endif

#include <limits>

#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// Where the line f + t dir passes the center, in the terms of a t^2 - 2 b t + c = 0. f: origin - center; a = dir.dir and
// inv_a = 1 / a, which a ray computes once.
template <class D>
struct SphereChord {
  using V = hn::Vec<D>;
  V b;
  V c;        // below 0 inside the sphere
  V inside2;  // radius^2 less the squared distance from the center: the line meets the sphere where it is not below 0

  HWY_INLINE SphereChord(const V (&f)[3], const V (&dir)[3], V inv_a, V radius) {
    b = hn::Neg(hn::MulAdd(f[0], dir[0], hn::MulAdd(f[1], dir[1], hn::Mul(f[2], dir[2]))));
    // The foot of the perpendicular from the center: its distance gives the discriminant without cancellation when the
    // sphere is many radii away.
    const V s = hn::Mul(b, inv_a);
    const V x = hn::MulAdd(s, dir[0], f[0]), y = hn::MulAdd(s, dir[1], f[1]), z = hn::MulAdd(s, dir[2], f[2]);
    const V r2 = hn::Mul(radius, radius);
    inside2 = hn::Sub(r2, hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z))));
    c = hn::Sub(hn::MulAdd(f[0], f[0], hn::MulAdd(f[1], f[1], hn::Mul(f[2], f[2]))), r2);
  }
};

// The nearest root above 0 in units of the direction dir, +inf for none.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V SphereRoot(D d, const V (&f)[3], const V (&dir)[3], V a, V inv_a, V radius) {
  const V zero = hn::Zero(d);
  const SphereChord<D> chord(f, dir, inv_a, radius);
  // Inside there is always a root ahead, whatever rounding makes of a grazing discriminant.
  const V depth2 = hn::IfThenElse(hn::Lt(chord.c, zero), hn::Max(chord.inside2, zero), chord.inside2);
  // The roots are c / q and q / a: no difference of like numbers. Of a negative depth2 the square root is NaN.
  const V q = hn::Add(chord.b, hn::CopySign(hn::Sqrt(hn::Mul(a, depth2)), chord.b));
  const V t0 = hn::Div(chord.c, q), t1 = hn::Mul(q, inv_a);
  const V near = hn::Min(t0, t1), far = hn::Max(t0, t1);
  const V root = hn::IfThenElse(hn::Gt(near, zero), near, far);
  return hn::IfThenElse(hn::And(hn::Ge(depth2, zero), hn::Gt(root, zero)), root,
                        hn::Set(d, std::numeric_limits<float>::infinity()));
}

// Whether that root is below 1, without it: no square root, no division.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> SphereWithinSegment(D d, const V (&f)[3], const V (&dir)[3], V a, V inv_a, V radius) {
  const V zero = hn::Zero(d);
  const SphereChord<D> chord(f, dir, inv_a, radius);
  // From outside c / (b + sqrt(a inside2)) < 1, ahead if b > 0; from inside (b + sqrt(a inside2)) / a < 1.
  const V half2 = hn::Mul(a, chord.inside2), short_of = hn::Sub(chord.c, chord.b), rest = hn::Sub(a, chord.b);
  const auto before = hn::Or(hn::Lt(short_of, zero), hn::Lt(hn::Mul(short_of, short_of), half2));
  const auto from_outside = hn::And(hn::And(hn::Gt(chord.b, zero), hn::Ge(chord.inside2, zero)), before);
  const auto from_inside = hn::And(hn::Gt(rest, zero), hn::Lt(half2, hn::Mul(rest, rest)));
  const auto inside = hn::Lt(chord.c, zero);
  return hn::Or(hn::And(inside, from_inside), hn::AndNot(inside, from_outside));
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
