#pragma once

#include <numbers>

#include "kernels/kernels.h"
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
  while (patch < last && random.u[0] >= T(patch->cdf)) ++patch;
  T u = random.u[1], v = random.u[2];
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
  const T u = random.u[1];
  const T z = 1 - 2 * u, r = 2 * std::sqrt(u * (1 - u));
  const T phi = 2 * std::numbers::pi_v<T> * random.u[2];
  const Vec3<T> n(r * std::cos(phi), r * std::sin(phi), z);
  return {vec3<T>(light.center) + T(light.radius + light.err) * n, n};
}

template <class T>
void sample_light(const Plan& plan, Path<T>& p) {
  const PlanLight& light = plan.lights[p.step.light];
  const uint32_t set = kSetLight + p.step.light * plan.settings.light_samples + p.step.light_sample;
  const Random4<T> random = draw_random(plan, p, set);
  const LightPoint<T> at = light.patches > 0 ? sample_patch(plan, light, random) : sample_sphere_light(light, random);
  const Vec3<T> hit = LANEWISE_VEC3(p, o);
  const Vec3<T> origin = offset_origin(hit, LANEWISE_VEC3(p, n), p.err, at.q - hit);
  const Vec3<T> l = at.q - origin;
  const T distance2 = glm::dot(l, l);
  const T cosine_distance = -glm::dot(l, at.n);
  LANEWISE_SET_VEC3(p, l, l);
  p.l_pdf = cosine_distance > 0 ? distance2 * std::sqrt(distance2) / (T(light.area) * cosine_distance) : T(0);
}

}  // namespace lanewise::reference
