#pragma once

#include "kernels/reference/rng.h"
#include "kernels/reference/sampling.h"
#include "kernels/reference/shading.h"

namespace lanewise::reference {

template <class T>
void sample_hemisphere(const Plan& plan, Path<T>& p) {
  const Vec3<T> normal = viewer_side(LANEWISE_VEC3(p, s), LANEWISE_VEC3(p, d));
  const auto random = draw_light(plan, p);
  Vec3<T> b1, b2;
  frame(normal, b1, b2);
  LANEWISE_SET_VEC3(p, l, to_world(uniform_hemisphere(random.u[kDrawLightU], random.u[kDrawLightV]), b1, b2, normal));
  p.l_pdf = std::numbers::inv_pi_v<T> / 2;
}

}  // namespace lanewise::reference
