// What the tests of the shading kernels share: plans of nothing but materials, and paths aimed at them.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "core/path_buffer.h"
#include "core/plan.h"
#include "core/verify/random_path.h"
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
