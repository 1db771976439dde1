#pragma once

#include "kernels/kernels.h"
#include "kernels/reference/light_point.h"
#include "kernels/reference/rng.h"
#include "kernels/reference/vec3.h"

namespace lanewise::reference {

template <class T>
void sample_light(const Plan& plan, Path<T>& p) {
  const PlanLight& light = plan.lights[p.step.light];
  const Random4<T> random = draw_light(plan, p);
  const LightPoint<T> at = sample_light_point(plan, light, random);
  const Vec3<T> hit = LANEWISE_VEC3(p, o);
  const Vec3<T> origin = offset_origin(hit, LANEWISE_VEC3(p, n), p.err, at.q - hit);
  const Vec3<T> l = at.q - origin;
  const T distance2 = glm::dot(l, l);
  const T cosine_distance = -glm::dot(l, at.n);
  LANEWISE_SET_VEC3(p, l, l);
  p.l_pdf = cosine_distance > 0 ? distance2 * std::sqrt(distance2) / (T(light.area) * cosine_distance) : T(0);
}

}  // namespace lanewise::reference
