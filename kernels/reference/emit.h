#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/plan_light_paths.h"
#include "kernels/reference/light_point.h"
#include "kernels/reference/rng.h"

namespace lanewise::reference {

// The cone in which a caster is seen: 1 - cosine of its half angle, and its axis; from inside, or near it, all directions.
template <class T>
struct Cone {
  Vec3<T> axis;
  T height;

  Cone(const Caster& caster, const Vec3<T>& from) {
    const Vec3<T> to = vec3<T>(caster.center) - from;
    const T distance2 = std::max(glm::dot(to, to), T(1e-30f)), sine2 = T(caster.radius) * T(caster.radius) / distance2;
    axis = to / std::sqrt(distance2);
    height = sine2 < T(kMostSine2) ? sine2 / (1 + std::sqrt(1 - sine2)) : T(2);
  }
  bool contains(const Vec3<T>& direction) const {
    return height == 2 || glm::dot(direction - axis, direction - axis) <= 2 * height;
  }
};

// p.pixel, p.sample and p.slot say which path; the kernel takes them from the batch.
template <class T>
void emit(const Plan& plan, Path<T>& p) {
  const PlanLight& light = plan.lights[p.step.light];
  const LampPaths& paths = plan.lamp_paths[p.step.light];
  const Random4<T> path = draw_random(plan, p, kSetPath), choice = draw_random(plan, p, kSetChoice);
  Random4<T> random{};
  random.u[kDrawPatch] = choice.u[kDrawFirstPatch];
  random.u[kDrawLightU] = path.u[kDrawU];
  random.u[kDrawLightV] = path.u[kDrawV];
  const LightPoint<T> at = sample_light_point(plan, light, random);

  std::vector<Cone<T>> cones;
  T total = 0;
  for (const Caster& caster : plan.casters) total += cones.emplace_back(caster, at.q).height;
  size_t chosen = 0;
  for (T below = cones[0].height; chosen + 1 < cones.size() && choice.u[kDrawCaster] * total >= below;
       below += cones[chosen].height) {
    ++chosen;
  }
  const Cone<T>& cone = cones[chosen];
  const T height = path.u[kDrawEmitU] * cone.height;  // 1 - cosine from the axis
  const T sine = std::sqrt(height * (2 - height)), phi = 2 * std::numbers::pi_v<T> * path.u[kDrawEmitV];
  Vec3<T> b1, b2;
  frame(cone.axis, b1, b2);
  const Vec3<T> d = to_world(Vec3<T>(sine * std::cos(phi), sine * std::sin(phi), 1 - height), b1, b2, cone.axis);
  T cover = 0;
  for (size_t k = 0; k < cones.size(); ++k) cover += k == chosen || cones[k].contains(d) ? T(1) : T(0);

  const float brightest = std::max({light.radiance[0], light.radiance[1], light.radiance[2]});
  const T angle = 2 * std::numbers::pi_v<T> * total / cover, cosine = std::max(glm::dot(d, at.n), T(0));
  LANEWISE_SET_RGB(p, beta, T(paths.throughput) * angle * cosine / T(brightest) * vec3<T>(light.radiance));
  LANEWISE_SET_VEC3(p, o, at.q);
  LANEWISE_SET_VEC3(p, d, d);
  LANEWISE_SET_RGB(p, L, Vec3<T>(0));
  p.pdf = 0;
  p.lamps = kByItself;
}

}  // namespace lanewise::reference
