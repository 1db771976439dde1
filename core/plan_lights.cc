#include "core/plan_lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallelogram.h"
#include "core/ray_offset.h"

namespace lanewise {
namespace {

using glm::dvec3;

void finish_light(Plan& plan, PlanLight light, const dvec3& radiance) {
  for (int k = 0; k < 3; ++k) light.radiance[k] = static_cast<float>(radiance[k]);
  plan.lights.push_back(light);
  plan.light_table.insert(plan.light_table.end(),
                          {light.radiance[0], light.radiance[1], light.radiance[2], light.area});
}

}  // namespace

void add_mesh_light(Plan& plan, std::span<const FlatTriangle> triangles, const dvec3& radiance) {
  const std::vector<Parallelogram> patches = find_parallelograms(triangles);
  double area = 0;
  for (const Parallelogram& p : patches) area += p.area();
  PlanLight light{};
  light.area = static_cast<float>(area);
  light.first_patch = static_cast<uint32_t>(plan.light_patches.size());
  light.patches = static_cast<uint32_t>(patches.size());
  for (const FlatTriangle& t : triangles) light.err = std::max(light.err, triangle_offset(t.v));
  double below = 0;
  for (const Parallelogram& p : patches) {
    below += p.area();
    LightPatch out{};
    const dvec3 n = glm::normalize(glm::cross(p.e1, p.e2));
    for (int k = 0; k < 3; ++k) {
      out.corner[k] = static_cast<float>(p.corner[k]);
      out.e1[k] = static_cast<float>(p.e1[k]);
      out.e2[k] = static_cast<float>(p.e2[k]);
      out.n[k] = static_cast<float>(n[k]);
    }
    out.cdf = static_cast<float>(below / area);
    out.is_triangle = p.is_triangle() ? 1.0f : 0.0f;
    plan.light_patches.push_back(out);
  }
  finish_light(plan, light, radiance);
}

void add_sphere_light(Plan& plan, const FlatSphere& sphere, const dvec3& radiance) {
  PlanLight light{};
  light.area = 4 * std::numbers::pi_v<float> * sphere.radius * sphere.radius;
  light.radius = sphere.radius;
  std::copy_n(sphere.center, 3, light.center);
  light.err = sphere_offset(sphere.center, sphere.radius);
  finish_light(plan, light, radiance);
}

}  // namespace lanewise
