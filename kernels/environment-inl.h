// The environment map by direction. Scalar twin: kernels/reference/environment_map.h.
#if defined(LANEWISE_KERNELS_ENVIRONMENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_ENVIRONMENT_INL_H_
#undef LANEWISE_KERNELS_ENVIRONMENT_INL_H_
#else
#define LANEWISE_KERNELS_ENVIRONMENT_INL_H_
#endif

#include "core/environment_map.h"
#include "kernels/math-inl.h"
#include "kernels/records-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// A cell of the map, and the place in it: x from the left, y from the top, in [0, 1].
struct SkyPlace {
  VI row, column;
  VF x, y;
};

struct Sky {
  Vec3 radiance;
  VF pdf;  // of environment samples, per steradian
};

HWY_INLINE Sky SkyAt(const EnvironmentMap& map, const SkyPlace& place) {
  const DI d;
  const size_t stride = size_t{map.width} + 1;
  const float* base = map.texels.data()->radiance;
  const VI index = hn::Add(hn::Mul(place.row, hn::Set(d, static_cast<int32_t>(stride))), place.column);
  HWY_ALIGN uint32_t lane[hn::MaxLanes(DU())];
  hn::Store(hn::BitCast(DU(), index), DU(), lane);
  const auto corner = [&](size_t offset, Vec3& radiance, VF& pdf) HWY_ATTR {
    LaneRecords(base + 4 * offset, 4, lane).Get4(0, radiance.x, radiance.y, radiance.z, pdf);
  };
  Sky sky;
  Vec3 a, b, e, f;
  VF unused;
  corner(0, a, sky.pdf);
  corner(1, b, unused);
  corner(stride, e, unused);
  corner(stride + 1, f, unused);
  const VF left = hn::Sub(Splat(1.0f), place.x), upper = hn::Sub(Splat(1.0f), place.y);
  sky.radiance = MulAdd(upper, MulAdd(place.x, b, Scale(left, a)), Scale(place.y, MulAdd(place.x, f, Scale(left, e))));
  return sky;
}

// Rows from the upper edge of the map's first row of cells down to the direction with this z and distance r from the axis.
HWY_INLINE VF SkyRow(const EnvironmentMap& map, VF r, VF z) {
  return hn::MulAdd(Atan2Turns(r, z), Splat(2 * static_cast<float>(map.height)), Splat(0.5f));
}

// The whole part of x, not above `most`; x becomes the rest.
HWY_INLINE VI TakeWhole(VF& x, uint32_t most) {
  const VI whole = hn::Min(hn::ConvertTo(DI(), x), hn::Set(DI(), static_cast<int32_t>(most)));
  x = hn::Sub(x, hn::ConvertTo(DF(), whole));
  return whole;
}

// Between the axes of the world and of the map.
HWY_INLINE Vec3 WorldToSky(const EnvironmentMap& map, const Vec3& w) {
  return map.y_up ? Vec3{w.x, hn::Neg(w.z), w.y} : w;
}
HWY_INLINE Vec3 SkyToWorld(const EnvironmentMap& map, const Vec3& w) {
  return map.y_up ? Vec3{w.x, w.z, hn::Neg(w.y)} : w;
}

// world: of any length but 0.
HWY_INLINE Sky SkyAlong(const EnvironmentMap& map, const Vec3& world) {
  const Vec3 dir = WorldToSky(map, world);
  const VF width = Splat(static_cast<float>(map.width));
  SkyPlace place;
  place.x = hn::MulSub(hn::Sub(Splat(0.5f), Atan2Turns(dir.y, dir.x)), width, Splat(0.5f));
  place.x = hn::Add(place.x, hn::IfThenElseZero(hn::Lt(place.x, hn::Zero(DF())), width));
  place.column = TakeWhole(place.x, map.width - 1);
  place.y = SkyRow(map, hn::Sqrt(hn::MulAdd(dir.x, dir.x, hn::Mul(dir.y, dir.y))), dir.z);
  place.row = TakeWhole(place.y, map.height);
  return SkyAt(map, place);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
