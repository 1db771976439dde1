// What the shading kernels of all materials share: the viewer's side, the material's members, the weight of a light
// sample. Scalar twin: kernels/reference/shading.h.
#if defined(LANEWISE_KERNELS_SHADING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_SHADING_INL_H_
#undef LANEWISE_KERNELS_SHADING_INL_H_
#else
#define LANEWISE_KERNELS_SHADING_INL_H_
#endif

#include <limits>

#include "core/plan.h"
#include "core/plan_connections.h"
#include "core/plan_light_paths.h"
#include "kernels/math-inl.h"
#include "kernels/records-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// The shading normal on the side that a ray in direction d arrives from: surfaces scatter alike from both sides.
HWY_INLINE Vec3 ViewerSide(const Vec3& s, const Vec3& d) {
  const MF behind = hn::Gt(Dot(d, s), hn::Zero(DF()));
  const VF flip = hn::IfThenElseZero(behind, Splat(-0.0f));
  return {hn::Xor(s.x, flip), hn::Xor(s.y, flip), hn::Xor(s.z, flip)};
}

// The materials of the paths from slot i on; members by MaterialMember.
struct LaneMaterials : LaneRecords {
  HWY_INLINE LaneMaterials(const Plan& plan, const PathState& s, size_t i) {
    static_assert(sizeof(PlanMaterial) == kMaterialStride * sizeof(float));
    const float* materials = plan.materials[0].reflectance;
    for (size_t k = 0; k < hn::Lanes(DF()); ++k) {
      lane[k] = materials + size_t{kMaterialStride} * plan.prim_material[s.prim[i + k]];
    }
  }
};

// Whether the direction w, of any length, agrees with both normals of the surface: see core/plan_light_paths.h.
HWY_INLINE MF Agrees(const PathState& s, size_t i, const Vec3& w) {
  const VF geometric = AbsDot(w, LoadVec3(s.n_x, s.n_y, s.n_z, i));
  const VF shading = AbsDot(w, LoadVec3(s.s_x, s.s_y, s.s_z, i));
  const VF least = Splat(kLeastAgreement);
  return hn::And(hn::Ge(geometric, hn::Mul(least, shading)), hn::Ge(shading, hn::Mul(least, geometric)));
}

// Of which paths light paths bring what lamps send next.
HWY_INLINE MF ByLightPaths(const PathState& s, size_t i) {
  return hn::RebindMask(DF(), hn::Eq(hn::Load(DU(), s.lamps + i), hn::Set(DU(), kByLightPaths)));
}

// What is the same for every path of a light sample.
struct LightTerms {
  Vec3 radiance;  // of the light; with -H it is not known yet, and 1 stands for it
  bool of_sky;
  bool from_paths;  // the environment's, which is each path's own
  VF samples;
  VF mis;       // 1: weigh against the material's own density, 0: do not
  VF most_pdf;  // directions of which the material's own density is larger are not for light samples

  explicit LightTerms(const Plan& plan, const Step& step)
      : radiance{Splat(1.0f), Splat(1.0f), Splat(1.0f)},
        of_sky(is_environment(plan, step.light)),
        from_paths(false),
        samples(Splat(static_cast<float>(plan.settings.light_samples))),
        mis(Splat(plan.settings.direct == Direct::kMis ? 1.0f : 0.0f)),
        most_pdf(Splat(std::numeric_limits<float>::infinity())) {
    if (plan.settings.direct != Direct::kHemisphere) {
      from_paths = of_sky;
      if (!from_paths) radiance = SplatVec3(plan.lights[step.light].radiance);
    }
    if (step.connection) mis = hn::Zero(DF()), most_pdf = Splat(kMostConnectedPdf);
  }

  // Whether the path looks for this light, in direction l, itself.
  HWY_INLINE MF Wanted(const Plan& plan, const PathState& s, size_t i, const Vec3& l) const {
    if (of_sky || !has_light_paths(plan)) return hn::Eq(samples, samples);
    const MF wanted = hn::Not(ByLightPaths(s, i));
    return plan.prim_normals.empty() ? wanted : hn::Or(wanted, hn::Not(Agrees(s, i, l)));
  }

  HWY_INLINE Vec3 Radiance(const PathState& s, size_t i) const {
    return from_paths ? LoadVec3(s.c_r, s.c_g, s.c_b, i) : radiance;
  }

  // w / (n l_pdf) with the power heuristic's w = (n l_pdf)^2 / ((n l_pdf)^2 + bsdf_pdf^2), by ratios, so that no square
  // leaves float's range. Of use only where l_pdf > 0.
  HWY_INLINE VF Weight(VF l_pdf, VF bsdf_pdf) const {
    const VF n_pdf = hn::Mul(samples, l_pdf);
    const VF ratio = hn::Mul(mis, hn::Min(hn::Div(bsdf_pdf, n_pdf), Splat(1e18f)));
    const VF weight = hn::Div(Splat(1.0f), hn::Mul(n_pdf, hn::MulAdd(ratio, ratio, Splat(1.0f))));
    return hn::IfThenElseZero(hn::Le(bsdf_pdf, most_pdf), weight);
  }
};

// What refraction multiplies radiance by, eta the index on the side of its viewer over that beyond: on the dense side it is
// squeezed into a narrower cone. The power that light paths carry is not.
HWY_INLINE VF Squeeze(const Step& step, VF eta) { return step.from_light ? Splat(1.0f) : hn::Mul(eta, eta); }

// What pdf becomes after a delta lobe: kConnected where it is the reflection, seen from outside, of a sphere by way of which
// the vertex before has been connected to the lights, and else 0.
HWY_INLINE VF PdfAfterDelta(const Plan& plan, const PathState& s, size_t i, MF reflects_outside) {
  const DF d;
  const DI di;
  const VF zero = hn::Zero(d);
  if (!connects(plan)) return zero;
  const VF pdf = hn::Load(d, s.pdf + i);
  const VI prim = hn::BitCast(di, hn::Load(DU(), s.prim + i));
  const MF of_sphere = hn::RebindMask(d, hn::Gt(prim, hn::Set(di, static_cast<int32_t>(plan.triangles) - 1)));
  const MF counted = hn::And(hn::Gt(pdf, zero), hn::Le(pdf, Splat(kMostConnectedPdf)));
  return hn::IfThenElseZero(hn::And(hn::And(reflects_outside, of_sphere), counted), Splat(kConnected));
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
