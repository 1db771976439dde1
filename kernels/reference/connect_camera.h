#pragma once

#include <cmath>
#include <numbers>

#include "kernels/reference/rng.h"
#include "kernels/reference/shading.h"

namespace lanewise::reference {

template <class T>
void connect_camera(const Plan& plan, Path<T>& p) {
  const PlanCamera& camera = plan.camera;
  const Window window = plan.settings.window();
  const Vec3<T> right = vec3<T>(camera.right), up = vec3<T>(camera.up), hit = LANEWISE_VEC3(p, o);
  const Vec3<T> n = LANEWISE_VEC3(p, n);
  T lens_x = 0, lens_y = 0;
  if (camera.lens_radius > 0) {
    const Random4<T> on_lens = draw_random(plan, p, kSetLens);
    const T r = std::sqrt(on_lens.u[kDrawU]), phi = 2 * std::numbers::pi_v<T> * on_lens.u[kDrawV];
    lens_x = r * std::cos(phi), lens_y = r * std::sin(phi);
  }
  const Vec3<T> e = vec3<T>(camera.eye) + T(camera.lens_radius) * (lens_x * right + lens_y * up);
  const Vec3<T> l = e - offset_origin(hit, n, p.err, e - hit);
  const T depth = -glm::dot(l, vec3<T>(camera.forward));
  // Where the ray from e through the point meets the picture at distance 1, were there no lens.
  const T across = T(camera.lens_angle) * lens_x - glm::dot(l, right) / depth;
  const T upwards = T(camera.lens_angle) * lens_y - glm::dot(l, up) / depth;
  const T pixel = T(camera.pixel), x = across / pixel + T(0.5) * T(plan.settings.width);
  const T y = T(0.5) * T(plan.settings.height) - upwards / pixel;

  const bool inside =
      x >= T(window.x) && x < T(window.x + window.width) && y >= T(window.y) && y < T(window.y + window.height);
  const bool agreed = plan.prim_normals.empty() || agrees(p, l);
  const bool seen =
      agreed && depth > 0 && inside && glm::dot(l, viewer_side(LANEWISE_VEC3(p, s), LANEWISE_VEC3(p, d))) > 0;
  // |n.l| / (|l|^3 cos^3), cos = depth / |l|
  const T weight = T(plan.lamp_paths[p.step.light].scale) * std::numbers::inv_pi_v<T> / (pixel * pixel) *
                   std::abs(glm::dot(l, n)) / (depth * depth * depth);
  const Vec3<T> albedo = plan.textures.empty() ? vec3<T>(material_at(plan, p).reflectance) : LANEWISE_RGB(p, a);
  LANEWISE_SET_RGB(p, c, seen ? weight * (LANEWISE_RGB(p, beta) * albedo) : Vec3<T>(0));
  LANEWISE_SET_VEC3(p, l, l);
  LANEWISE_SET_RGB(p, L, Vec3<T>(0));
  p.raster = seen ? static_cast<uint32_t>(y) * plan.settings.width + static_cast<uint32_t>(x) : 0;
}

}  // namespace lanewise::reference
