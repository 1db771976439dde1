#include "core/plan_connections.h"

#include <algorithm>
#include <cmath>

namespace lanewise {
namespace {

// Whether two spheres are the same up to rounding. A ray meets the first of them, both would be connected.
bool coincide(const float* a, const float* b, float err) {
  float apart = std::abs(a[3] - b[3]);
  for (int k = 0; k < 3; ++k) apart = std::max(apart, std::abs(a[k] - b[k]));
  return apart <= 2 * err;
}

bool has_double(const Plan& plan, uint32_t prim) {
  const float* shapes = plan.prim_shape.data();
  for (uint32_t other = plan.triangles; other < plan.triangles + plan.spheres; ++other) {
    if (other == prim) continue;
    if (coincide(shapes + 4 * size_t{prim}, shapes + 4 * size_t{other}, plan.prim_err[prim])) return true;
  }
  return false;
}

// What a sphere of glass reflects of light from afar: the mean over its disc of Schlick's reflectance.
double mean_reflectance(double ior) {
  const double f0 = (ior - 1) * (ior - 1) / ((ior + 1) * (ior + 1));
  return f0 + (1 - f0) / 21;
}

ConnectedSphere connected(const Plan& plan, uint32_t prim) {
  const PlanMaterial& material = plan.materials[plan.prim_material[prim]];
  const float* shape = &plan.prim_shape[4 * size_t{prim}];
  ConnectedSphere out;
  std::copy_n(shape, 3, out.center);
  out.radius = shape[3];
  out.err = plan.prim_err[prim];
  std::copy_n(material.reflectance, 3, out.reflectance);
  const bool glass = plan.prim_bin[prim] == kGlass;
  out.ior = glass ? material.ior : 0;
  const double share = glass ? mean_reflectance(material.ior) : 1;
  const float reflectance = std::max({material.reflectance[0], material.reflectance[1], material.reflectance[2]});
  out.importance = static_cast<float>(share) * reflectance;
  return out;
}

}  // namespace

void connect_spheres(Plan& plan) {
  const Settings& settings = plan.settings;
  const bool takes_light_samples = settings.direct == Direct::kMis || settings.direct == Direct::kLight;
  if (!settings.connect || !takes_light_samples) return;
  std::vector<ConnectedSphere> spheres;
  for (uint32_t prim = plan.triangles; prim < plan.triangles + plan.spheres; ++prim) {
    if (plan.prim_bin[prim] != kMirror && plan.prim_bin[prim] != kGlass) continue;
    if (spheres.size() == kMaxConnectedSpheres || has_double(plan, prim)) return;
    const ConnectedSphere sphere = connected(plan, prim);
    if (sphere.importance > 0) spheres.push_back(sphere);
  }
  if (!plan.lights.empty() && plan.lights.size() <= kMaxConnectedLights) plan.connected_spheres = std::move(spheres);
}

}  // namespace lanewise
