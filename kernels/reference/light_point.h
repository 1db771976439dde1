// Scalar twin of kernels/light_point-inl.h.
#pragma once

#include <cmath>
#include <numbers>

#include "core/plan.h"
#include "kernels/reference/rng.h"
#include "kernels/reference/vec3.h"

namespace lanewise::reference {

// A point on the light, offset off it on the side of n, the unit normal there.
template <class T>
struct LightPoint {
  Vec3<T> q;
  Vec3<T> n;
};

template <class T>
LightPoint<T> sample_patch(const Plan& plan, const PlanLight& light, const Random4<T>& random) {
  const LightPatch* patch = &plan.light_patches[light.first_patch];
  const LightPatch* last = patch + light.patches - 1;
  while (patch < last && random.u[kDrawPatch] >= T(patch->cdf)) ++patch;
  T u = random.u[kDrawLightU], v = random.u[kDrawLightV];
  if (patch->is_triangle != 0) {
    const T root = std::sqrt(u);
    u = 1 - root;
    v *= root;
  }
  const Vec3<T> n = vec3<T>(patch->n);
  return {vec3<T>(patch->corner) + u * vec3<T>(patch->e1) + v * vec3<T>(patch->e2) + T(light.err) * n, n};
}

template <class T>
LightPoint<T> sample_sphere_light(const PlanLight& light, const Random4<T>& random) {
  const T u = random.u[kDrawLightU];
  const T z = 1 - 2 * u, r = 2 * std::sqrt(u * (1 - u));
  const T phi = 2 * std::numbers::pi_v<T> * random.u[kDrawLightV];
  const Vec3<T> n(r * std::cos(phi), r * std::sin(phi), z);
  return {vec3<T>(light.center) + T(light.radius + light.err) * n, n};
}

template <class T>
LightPoint<T> sample_light_point(const Plan& plan, const PlanLight& light, const Random4<T>& random) {
  return light.patches > 0 ? sample_patch(plan, light, random) : sample_sphere_light(light, random);
}

}  // namespace lanewise::reference
