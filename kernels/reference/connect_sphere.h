#pragma once

#include "core/plan_connections.h"
#include "kernels/kernels.h"
#include "kernels/reference/fresnel.h"
#include "kernels/reference/light_point.h"
#include "kernels/reference/reflection.h"
#include "kernels/reference/shading.h"

namespace lanewise::reference {

// The chance of each of the plan's connected spheres to be chosen from x.
template <class T>
std::vector<T> sphere_chances(const Plan& plan, const Vec3<T>& x) {
  std::vector<T> chances;
  T total = 0;
  for (const ConnectedSphere& sphere : plan.connected_spheres) {
    const Vec3<T> to = x - vec3<T>(sphere.center);
    chances.push_back(T(sphere.importance) / std::max(glm::dot(to, to) / square(T(sphere.radius)), T(1)));
    total += chances.back();
  }
  for (T& chance : chances) chance /= total;
  return chances;
}

template <class T>
void connect_sphere(const Plan& plan, Path<T>& p) {
  const PlanLight& light = plan.lights[p.step.light];
  const Random4<T> random = draw_random(plan, p, connection_set(plan, p.step));
  const LightPoint<T> at = sample_light_point(plan, light, random);
  const Vec3<T> hit = LANEWISE_VEC3(p, o);
  const std::vector<T> chances = sphere_chances(plan, hit);
  p.via = 0;
  for (T below = chances[0]; p.via + 1 < chances.size() && random.u[kDrawSphere] >= below; below += chances[p.via])
    ++p.via;
  const ConnectedSphere& sphere = plan.connected_spheres[p.via];
  const Vec3<T> center = vec3<T>(sphere.center);

  const SphereReflection<T> reflection = reflect_in_sphere(hit - center, at.q - center, T(sphere.radius));
  const Vec3<T> met = center + T(sphere.radius + sphere.err) * reflection.n;
  const Vec3<T> origin = offset_origin(hit, LANEWISE_VEC3(p, n), p.err, met - hit);
  // The spread on the light's own area, over that.
  T facing = T(light.area) * -glm::dot(reflection.to_y, at.n) / reflection.distance;
  if (sphere.ior > 0) {
    facing *= fresnel_dielectric(plan.settings.fresnel, reflection.cosine, T(1), T(sphere.ior)).reflectance;
  }
  const bool wanted = p.lamps == kByItself || disagrees(plan, p, met - origin);
  const bool usable = wanted && reflection.exists && facing > 0;
  LANEWISE_SET_VEC3(p, l, usable ? met - origin : Vec3<T>(0));
  LANEWISE_SET_VEC3(p, m, usable ? at.q - met : Vec3<T>(0));
  const T chance = chances[p.via];
  if (!usable) p.via = 0;
  p.l_pdf = usable ? chance * reflection.spread / facing : T(0);
}

}  // namespace lanewise::reference
