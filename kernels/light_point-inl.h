// A point on a light, uniform by area. Scalar twin: kernels/reference/light_point.h.
#if defined(LANEWISE_KERNELS_LIGHT_POINT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_LIGHT_POINT_INL_H_
#undef LANEWISE_KERNELS_LIGHT_POINT_INL_H_
#else
#define LANEWISE_KERNELS_LIGHT_POINT_INL_H_
#endif

#include "core/plan.h"
#include "kernels/math-inl.h"
#include "kernels/rng-inl.h"
#include "kernels/sampling-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

struct LightPoint {
  Vec3 q;  // offset off the light on the side of n
  Vec3 n;  // unit normal of the side that emits
};

HWY_INLINE LightPoint SamplePatch(const Plan& plan, const PlanLight& light, const Random4& random) {
  const LightPatch* patches = plan.light_patches.data() + light.first_patch;
  Vec3 corner, e1, e2, n;
  MF is_triangle;
  if (light.patches == 1) {
    corner = SplatVec3(patches->corner), e1 = SplatVec3(patches->e1), e2 = SplatVec3(patches->e2),
    n = SplatVec3(patches->n);
    is_triangle = hn::Ne(Splat(patches->is_triangle), hn::Zero(DF()));
  } else {
    const float* base = patches->corner;
    const VI patch = FindInterval(base + kCdf, hn::Zero(DI()), kLightPatchStride, light.patches, random.u[kDrawPatch]);
    const VI at = hn::Mul(patch, hn::Set(DI(), kLightPatchStride));
    corner = GatherVec3(base + kCorner, at), e1 = GatherVec3(base + kE1, at), e2 = GatherVec3(base + kE2, at);
    n = GatherVec3(base + kPatchNormal, at);
    is_triangle = hn::Ne(hn::GatherIndex(DF(), base + kIsTriangle, at), hn::Zero(DF()));
  }
  // A triangle is the parallelogram's half with u + v <= 1; the square root makes u's density fit.
  const VF one = Splat(1.0f);
  const VF root = hn::Sqrt(random.u[kDrawLightU]);
  const VF u = hn::IfThenElse(is_triangle, hn::Sub(one, root), random.u[kDrawLightU]);
  const VF v = hn::IfThenElse(is_triangle, hn::Mul(random.u[kDrawLightV], root), random.u[kDrawLightV]);
  const Vec3 q = MulAdd(u, e1, MulAdd(v, e2, corner));
  return {MulAdd(Splat(light.err), n, q), n};
}

// Uniform on the sphere (Archimedes): z is uniform in [-1, 1].
HWY_INLINE LightPoint SampleSphereLight(const PlanLight& light, const Random4& random) {
  VF sin, cos;
  SinCos2Pi(random.u[kDrawLightV], sin, cos);
  const VF u = random.u[kDrawLightU], one = Splat(1.0f);
  const VF r = hn::Mul(Splat(2.0f), hn::Sqrt(hn::Mul(u, hn::Sub(one, u))));  // sqrt(1 - z^2) without its cancellation
  const Vec3 n = {hn::Mul(r, cos), hn::Mul(r, sin), hn::NegMulAdd(Splat(2.0f), u, one)};
  return {MulAdd(Splat(light.radius + light.err), n, SplatVec3(light.center)), n};
}

HWY_INLINE LightPoint SampleLightPoint(const Plan& plan, const PlanLight& light, const Random4& random) {
  return light.patches > 0 ? SamplePatch(plan, light, random) : SampleSphereLight(light, random);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
