#include <bit>

#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/sample_light.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/math-inl.h"
#include "kernels/rng-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

struct LightPoint {
  Vec3 q;  // offset off the light on the side of n
  Vec3 n;  // unit normal of the side that emits
};

// The first patch of the light whose cdf exceeds u, by a search that takes the same steps in all lanes.
HWY_INLINE VI FindPatch(const float* patches, const PlanLight& light, VF u) {
  const DI d;
  const VI last = hn::Set(d, static_cast<int32_t>(light.patches) - 1);
  VI first = hn::Zero(d);
  for (uint32_t step = std::bit_floor(light.patches - 1); step > 0; step >>= 1) {
    const VI probe = hn::Min(hn::Add(first, hn::Set(d, static_cast<int32_t>(step))), last);
    const VI before = hn::Mul(hn::Sub(probe, hn::Set(d, 1)), hn::Set(d, kLightPatchStride));
    const VF below = hn::GatherIndex(DF(), patches + kCdf, before);
    first = hn::IfThenElse(hn::RebindMask(d, hn::Ge(u, below)), probe, first);
  }
  return first;
}

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
    const VI at = hn::Mul(FindPatch(base, light, random.u[0]), hn::Set(DI(), kLightPatchStride));
    corner = GatherVec3(base + kCorner, at), e1 = GatherVec3(base + kE1, at), e2 = GatherVec3(base + kE2, at);
    n = GatherVec3(base + kPatchNormal, at);
    is_triangle = hn::Ne(hn::GatherIndex(DF(), base + kIsTriangle, at), hn::Zero(DF()));
  }
  // A triangle is the parallelogram's half with u + v <= 1; the square root makes u's density fit.
  const VF one = Splat(1.0f);
  const VF root = hn::Sqrt(random.u[1]);
  const VF u = hn::IfThenElse(is_triangle, hn::Sub(one, root), random.u[1]);
  const VF v = hn::IfThenElse(is_triangle, hn::Mul(random.u[2], root), random.u[2]);
  const Vec3 q = MulAdd(u, e1, MulAdd(v, e2, corner));
  return {MulAdd(Splat(light.err), n, q), n};
}

// Uniform on the sphere (Archimedes): z is uniform in [-1, 1].
HWY_INLINE LightPoint SampleSphereLight(const PlanLight& light, const Random4& random) {
  VF sin, cos;
  SinCos2Pi(random.u[2], sin, cos);
  const VF u = random.u[1], one = Splat(1.0f);
  const VF r = hn::Mul(Splat(2.0f), hn::Sqrt(hn::Mul(u, hn::Sub(one, u))));  // sqrt(1 - z^2) without its cancellation
  const Vec3 n = {hn::Mul(r, cos), hn::Mul(r, sin), hn::NegMulAdd(Splat(2.0f), u, one)};
  return {MulAdd(Splat(light.radius + light.err), n, SplatVec3(light.center)), n};
}

void SampleLight(const Plan& plan, const PathState& s, Range range) {
  const DF d;
  const PlanLight& light = plan.lights[s.step.light];
  const uint32_t set = kSetLight + s.step.light * plan.settings.light_samples + s.step.light_sample;
  const VF area = Splat(light.area), zero = hn::Zero(d);
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const Random4 random = DrawRandom(plan, s, i, set);
    const LightPoint at = light.patches > 0 ? SamplePatch(plan, light, random) : SampleSphereLight(light, random);
    const Vec3 p = LoadVec3(s.o_x, s.o_y, s.o_z, i);
    const Vec3 n = LoadVec3(s.n_x, s.n_y, s.n_z, i);
    const Vec3 origin = OffsetOrigin(p, n, hn::Load(d, s.err + i), Sub(at.q, p));
    const Vec3 l = Sub(at.q, origin);
    const VF distance2 = Dot(l, l);
    const VF cosine_distance = hn::Neg(Dot(l, at.n));
    // distance^2 / (area cos) with cos = cosine_distance / distance
    const VF pdf = hn::Div(hn::Mul(distance2, hn::Sqrt(distance2)), hn::Mul(area, cosine_distance));
    StoreVec3(l, s.l_x, s.l_y, s.l_z, i);
    hn::Store(hn::IfThenElseZero(hn::Gt(cosine_distance, zero), pdf), d, s.l_pdf + i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(SampleLight, sample_light);
}  // namespace lanewise
#endif
