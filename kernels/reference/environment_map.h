// Scalar twin of kernels/environment-inl.h.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/environment_map.h"
#include "kernels/reference/vec3.h"

namespace lanewise::reference {

template <class T>
struct SkyPlace {
  uint32_t row, column;
  T x, y;
};

template <class T>
struct Sky {
  Vec3<T> radiance;
  T pdf;
};

template <class T>
Sky<T> sky_at(const EnvironmentMap& map, const SkyPlace<T>& place) {
  const size_t stride = size_t{map.width} + 1;
  const EnvironmentMap::Texel* corner = &map.texels[place.row * stride + place.column];
  const auto radiance = [&](size_t offset) { return vec3<T>(corner[offset].radiance); };
  const Vec3<T> upper = (1 - place.x) * radiance(0) + place.x * radiance(1);
  const Vec3<T> lower = (1 - place.x) * radiance(stride) + place.x * radiance(stride + 1);
  return {(1 - place.y) * upper + place.y * lower, T(corner->pdf)};
}

template <class T>
T atan2_turns(T y, T x) {
  return std::atan2(y, x) / (2 * std::numbers::pi_v<T>);
}

template <class T>
T sky_row(const EnvironmentMap& map, T r, T z) {
  return 2 * atan2_turns(r, z) * T(map.height) + T(0.5);
}

template <class T>
uint32_t take_whole(T& x, uint32_t most) {
  const uint32_t whole = std::min(static_cast<uint32_t>(x), most);
  x -= T(whole);
  return whole;
}

template <class T>
Vec3<T> world_to_sky(const EnvironmentMap& map, const Vec3<T>& w) {
  return map.y_up ? Vec3<T>(w.x, -w.z, w.y) : w;
}
template <class T>
Vec3<T> sky_to_world(const EnvironmentMap& map, const Vec3<T>& w) {
  return map.y_up ? Vec3<T>(w.x, w.z, -w.y) : w;
}

template <class T>
Sky<T> sky_along(const EnvironmentMap& map, const Vec3<T>& world) {
  const Vec3<T> dir = world_to_sky(map, world);
  SkyPlace<T> place;
  place.x = (T(0.5) - atan2_turns(dir.y, dir.x)) * T(map.width) - T(0.5);
  if (place.x < 0) place.x += T(map.width);
  place.column = take_whole(place.x, map.width - 1);
  place.y = sky_row(map, std::sqrt(dir.x * dir.x + dir.y * dir.y), dir.z);
  place.row = take_whole(place.y, map.height);
  return sky_at(map, place);
}

}  // namespace lanewise::reference
