// One triangle test for the flat list (many rays, one triangle) and the tree's leaves (one ray, kLeafWidth triangles).
// Woop, Benthin & Wald, Watertight Ray/Triangle Intersection, JCGT 2(1), 2013: vertices are projected along the ray,
// each by itself, and the ray meets the triangle if the origin is on the same side of all three edges. Triangles that
// share an edge compute the same products for it, so no ray passes between them.
#if defined(LANEWISE_KERNELS_TRIANGLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_TRIANGLE_INL_H_
#undef LANEWISE_KERNELS_TRIANGLE_INL_H_
#else
#define LANEWISE_KERNELS_TRIANGLE_INL_H_
#endif

#include "core/plan.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// A direction's projection: its largest axis changes places with z, and then x -= s_x z, y -= s_y z take the ray to the
// z axis, where z s_z is the distance in units of the direction, which need not be a unit vector.
struct Shear {
  MF x_major, y_major;
  VF s_x, s_y, s_z;
};

HWY_INLINE Shear MakeShear(const Vec3& dir) {
  const VF x = hn::Abs(dir.x), y = hn::Abs(dir.y), z = hn::Abs(dir.z);
  Shear shear;
  shear.x_major = hn::And(hn::Ge(x, y), hn::Ge(x, z));
  shear.y_major = hn::AndNot(shear.x_major, hn::Ge(y, z));
  const VF major = hn::IfThenElse(shear.x_major, dir.x, hn::IfThenElse(shear.y_major, dir.y, dir.z));
  shear.s_x = hn::Div(hn::IfThenElse(shear.x_major, dir.z, dir.x), major);
  shear.s_y = hn::Div(hn::IfThenElse(shear.y_major, dir.z, dir.y), major);
  shear.s_z = hn::Div(Splat(1.0f), major);
  return shear;
}

// Edge functions of the lanes that may be inside but have a 0 among them, again in double, where products of floats are
// exact and so is the sign of their difference. Rare: rays that meet an edge to the last bit.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_NOINLINE void ExactEdges(D d, M lanes, const V (&x)[3], const V (&y)[3], V (&edge)[3]) {
  HWY_ALIGN float xs[3][kLanes], ys[3][kLanes], edges[3][kLanes];
  HWY_ALIGN float wanted[kLanes];
  for (int k = 0; k < 3; ++k) {
    hn::Store(x[k], d, xs[k]);
    hn::Store(y[k], d, ys[k]);
    hn::Store(edge[k], d, edges[k]);
  }
  hn::Store(hn::IfThenElseZero(lanes, hn::Set(d, 1.0f)), d, wanted);
  for (size_t i = 0; i < hn::Lanes(d); ++i) {
    if (wanted[i] == 0) continue;
    for (int k = 0; k < 3; ++k) {
      const int p = (k + 1) % 3, q = (k + 2) % 3;
      edges[k][i] = static_cast<float>(double{xs[q][i]} * double{ys[p][i]} - double{ys[q][i]} * double{xs[p][i]});
    }
  }
  for (int k = 0; k < 3; ++k) edge[k] = hn::Load(d, edges[k]);
}

// weight[k] / det is the barycentric weight of vertex k, depth / det the distance in units of the ray's direction.
// Where inside is true, det is not 0 unless the triangle is seen edge-on, and then the quotients are NaN.
template <class D>
struct TriangleTest {
  hn::Vec<D> weight[3], det, depth;
  hn::Mask<D> inside;
};

// Takes the vertices x, y, z, relative to the ray's origin and with the ray's major axis as z, along the ray to the plane
// z = 0, in place. weight[k]: the edge function opposite vertex k.
template <class V>
HWY_INLINE void EdgeFunctions(V (&x)[3], V (&y)[3], const V (&z)[3], V s_x, V s_y, V (&weight)[3]) {
  HWY_UNROLL(3)
  for (int k = 0; k < 3; ++k) {
    x[k] = hn::NegMulAdd(s_x, z[k], x[k]);
    y[k] = hn::NegMulAdd(s_y, z[k], y[k]);
  }
  // Two products and a difference, each rounded: so the two triangles at an edge get values that are each other's
  // negation, and a sign is never wrong, for rounding is monotonic; at worst the value is 0.
  weight[0] = hn::Sub(hn::Mul(x[2], y[1]), hn::Mul(y[2], x[1]));
  weight[1] = hn::Sub(hn::Mul(x[0], y[2]), hn::Mul(y[0], x[2]));
  weight[2] = hn::Sub(hn::Mul(x[1], y[0]), hn::Mul(y[1], x[0]));
}

// det and depth from the weights.
template <class V, class Test>
HWY_INLINE void FinishTest(const V (&z)[3], V s_z, Test& test) {
  const V(&w)[3] = test.weight;
  test.det = hn::Add(w[0], hn::Add(w[1], w[2]));
  test.depth = hn::Mul(s_z, hn::MulAdd(w[0], z[0], hn::MulAdd(w[1], z[1], hn::Mul(w[2], z[2]))));
}

// What TestTriangle says where no edge function is 0, without its slow way and without dividing.
template <class D>
struct QuickTest {
  hn::Vec<D> weight[3], det, depth;
  hn::Mask<D> hit;       // with 0 <= depth / det <= t_max, give or take some rounding
  hn::Mask<D> doubtful;  // an edge function is 0: TestTriangle may say otherwise
};
template <class D, class V = hn::Vec<D>>
HWY_INLINE QuickTest<D> TestQuickly(D d, V (&x)[3], V (&y)[3], const V (&z)[3], V s_x, V s_y, V s_z, float t_max) {
  QuickTest<D> test;
  V(&w)[3] = test.weight;
  EdgeFunctions(x, y, z, s_x, s_y, w);
  const V zero = hn::Zero(d);
  const V least = hn::Min(w[0], hn::Min(w[1], w[2])), most = hn::Max(w[0], hn::Max(w[1], w[2]));
  FinishTest(z, s_z, test);
  // Rounding in depth, det and the quotient moves the limits by less than this; the product may underflow.
  constexpr float kRounding = 1 + 0x1p-20f, kSmallest = 0x1p-140f;
  const V sided = hn::Xor(test.depth, hn::And(test.det, hn::SignBit(d)));
  const V limit = hn::MulAdd(hn::Abs(test.det), hn::Set(d, t_max * kRounding), hn::Set(d, kSmallest));
  const auto clear = hn::Or(hn::Gt(least, zero), hn::Lt(most, zero));
  const auto inside = hn::Or(hn::Ge(least, zero), hn::Le(most, zero));
  test.hit = hn::And(clear, hn::And(hn::Ge(sided, zero), hn::Le(sided, limit)));
  test.doubtful = hn::AndNot(clear, inside);
  return test;
}

// x, y, z as for EdgeFunctions. Lanes out of `valid` may be reported inside; they only never take the slow way.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE TriangleTest<D> TestTriangle(D d, M valid, V (&x)[3], V (&y)[3], const V (&z)[3], V s_x, V s_y, V s_z) {
  TriangleTest<D> test;
  V(&w)[3] = test.weight;
  EdgeFunctions(x, y, z, s_x, s_y, w);
  const V zero = hn::Zero(d);
  V least = hn::Min(w[0], hn::Min(w[1], w[2])), most = hn::Max(w[0], hn::Max(w[1], w[2]));
  test.inside = hn::Or(hn::Ge(least, zero), hn::Le(most, zero));
  const M clear = hn::Or(hn::Gt(least, zero), hn::Lt(most, zero));
  const M doubtful = hn::And(valid, hn::AndNot(clear, test.inside));
  if (HWY_UNLIKELY(!hn::AllFalse(d, doubtful))) {
    // Copies, so that the usual case keeps everything in registers.
    const V xs[3] = {x[0], x[1], x[2]}, ys[3] = {y[0], y[1], y[2]};
    V exact[3] = {w[0], w[1], w[2]};
    ExactEdges(d, doubtful, xs, ys, exact);
    w[0] = exact[0];
    w[1] = exact[1];
    w[2] = exact[2];
    least = hn::Min(w[0], hn::Min(w[1], w[2]));
    most = hn::Max(w[0], hn::Max(w[1], w[2]));
    test.inside = hn::Or(hn::Ge(least, zero), hn::Le(most, zero));
  }
  FinishTest(z, s_z, test);
  return test;
}

// One triangle against a ray in each lane.
HWY_INLINE TriangleTest<DF> TestTriangle(const FlatTriangle& triangle, const Vec3& o, const Shear& shear, MF valid) {
  VF x[3], y[3], z[3];
  HWY_UNROLL(3)
  for (int k = 0; k < 3; ++k) {
    const Vec3 v = Sub(SplatVec3(triangle.v[k]), o);
    x[k] = hn::IfThenElse(shear.x_major, v.z, v.x);
    y[k] = hn::IfThenElse(shear.y_major, v.z, v.y);
    z[k] = hn::IfThenElse(shear.x_major, v.x, hn::IfThenElse(shear.y_major, v.y, v.z));
  }
  return TestTriangle(DF(), valid, x, y, z, shear.s_x, shear.s_y, shear.s_z);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
