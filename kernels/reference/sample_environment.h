#pragma once

#include "core/plan.h"
#include "kernels/reference/environment_map.h"
#include "kernels/reference/rng.h"
#include "kernels/reference/vec3.h"

namespace lanewise::reference {

template <class T>
void sample_environment(const Plan& plan, Path<T>& p) {
  const EnvironmentMap& map = plan.environment;
  const Random4<T> random = draw_environment(plan, p);
  SkyPlace<T> place{};
  while (random.u[kDrawSkyRow] >= T(map.rows[place.row].cdf)) ++place.row;
  const float* column_cdf = &map.column_cdf[size_t{place.row} * map.width];
  while (random.u[kDrawSkyColumn] >= T(column_cdf[place.column])) ++place.column;
  place.x = random.u[kDrawSkyX];

  const EnvironmentMap::Row& row = map.rows[place.row];
  const T height = T(row.height) + random.u[kDrawSkyY] * T(row.below);
  const T r = std::sqrt(height * (2 - height)), z = T(row.side) * (1 - height);
  place.y = std::clamp(sky_row(map, r, z) - T(place.row), T(0), T(1));

  const T phi = 2 * std::numbers::pi_v<T> * (T(place.column) + place.x + T(0.5)) / T(map.width);
  const Vec3<T> direction(-r * std::cos(phi), r * std::sin(phi), z);
  const Vec3<T> l = sky_to_world(map, T(map.reach) * direction);
  LANEWISE_SET_VEC3(p, l, l);
  const Sky<T> sky = sky_at(map, place);
  p.l_pdf = sky.pdf;
  LANEWISE_SET_RGB(p, c, sky.radiance);
}

}  // namespace lanewise::reference
