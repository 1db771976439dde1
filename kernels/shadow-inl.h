// Shadow rays, as `sample_light` and the light kernels leave them.
#if defined(LANEWISE_KERNELS_SHADOW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_SHADOW_INL_H_
#undef LANEWISE_KERNELS_SHADOW_INL_H_
#else
#define LANEWISE_KERNELS_SHADOW_INL_H_
#endif

#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// Which light samples, of radiance c, are worth a ray.
HWY_INLINE MF IsWanted(const Vec3& c) {
  return hn::Gt(MaxElement({hn::Abs(c.x), hn::Abs(c.y), hn::Abs(c.z)}), hn::Zero(DF()));
}

// Where the shadow rays along l begin.
HWY_INLINE Vec3 ShadowOrigin(const PathState& s, size_t i, const Vec3& l) {
  const Vec3 n = LoadVec3(s.n_x, s.n_y, s.n_z, i);
  return OffsetOrigin(LoadVec3(s.o_x, s.o_y, s.o_z, i), n, hn::Load(DF(), s.err + i), l);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
