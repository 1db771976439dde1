// What the tests of the shading kernels share: plans of nothing but materials, and paths aimed at them.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "core/path_buffer.h"
#include "core/plan.h"
#include "kernels/reference/vec3.h"

namespace lanewise::test {

// A plan of one primitive a material, and one light; all that shading reads of a plan.
inline Plan material_plan(const std::vector<PlanMaterial>& materials, const Settings& settings = {}) {
  Plan plan;
  plan.settings = settings;
  plan.triangles = static_cast<uint32_t>(materials.size());
  for (uint32_t i = 0; i < materials.size(); ++i) {
    plan.materials.push_back(materials[i]);
    plan.prim_material.push_back(i);
    plan.prim_bin.push_back(kDiffuse);
  }
  PlanLight light{};
  light.radiance[0] = 20, light.radiance[1] = 10, light.radiance[2] = 5;
  plan.lights.push_back(light);
  return plan;
}

inline PlanMaterial grey(float reflectance) {
  PlanMaterial m{};
  for (int c = 0; c < 3; ++c) m.reflectance[c] = reflectance, m.transmittance[c] = 1;
  m.ior = 1;
  m.alpha = 1;
  return m;
}

inline PlanMaterial glass(float ior) {
  PlanMaterial m = grey(0.9f);
  m.transmittance[1] = 0.8f;
  m.ior = ior;
  return m;
}

inline PlanMaterial metal(float alpha, const std::array<float, 3>& eta, const std::array<float, 3>& k) {
  PlanMaterial m = grey(1);
  m.alpha = alpha;
  for (int c = 0; c < 3; ++c) m.eta[c] = eta[c], m.k[c] = k[c];
  return m;
}

inline PlanMaterial gold(float alpha) {
  return metal(alpha, {0.21646f, 0.42833f, 1.3284f}, {3.2390f, 2.4599f, 1.8661f});
}
// Index 0: every facet reflects all.
inline PlanMaterial white_metal(float alpha) { return metal(alpha, {0, 0, 0}, {0, 0, 0}); }

// Turns the path to arrive at the given cosine to its shading normal: positive from its front, negative from behind.
inline void arrive(std::mt19937& rng, Path<float>& p, float cosine) {
  using reference::Vec3;
  std::uniform_real_distribution<double> turn(0, 2 * std::numbers::pi);
  const Vec3<double> s = glm::normalize(Vec3<double>(p.s_x, p.s_y, p.s_z));
  Vec3<double> b1, b2;
  reference::frame(s, b1, b2);
  const double phi = turn(rng), sine = std::sqrt(std::max(0.0, 1 - double(cosine) * cosine));
  const Vec3<double> d = -reference::to_world<double>({sine * std::cos(phi), sine * std::sin(phi), cosine}, b1, b2, s);
  p.d_x = static_cast<float>(d.x), p.d_y = static_cast<float>(d.y), p.d_z = static_cast<float>(d.z);
}

// n paths that hit prim 0 at the origin, n = s = +z, arriving at cosine `cosine` in the xz plane, beta = 1; each a
// sample.
inline void fill_alike(PathBuffer& paths, uint32_t n, double cosine) {
  for (uint32_t i = 0; i < n; ++i) {
    Path<float> p;
    p.pixel = 3;
    p.sample = i;
    p.slot = i;
    p.d_x = static_cast<float>(-std::sqrt(1 - cosine * cosine));
    p.d_z = static_cast<float>(-cosine);
    p.n_z = p.s_z = 1;
    p.beta_r = p.beta_g = p.beta_b = 1;
    p.l_z = 1;
    p.l_pdf = 1;
    store_path(paths.state(), i, p);
  }
}

}  // namespace lanewise::test
