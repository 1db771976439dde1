#include "core/plan_lights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace lanewise {
namespace {

using glm::dvec3;
using Corner = std::array<float, 3>;

// Ulps of the light's extent that its points are moved off it: a point is a sum of three rounded products.
constexpr float kLightErrorUlps = 8;

dvec3 vertex(const FlatTriangle& t, int k) { return {t.v[k][0], t.v[k][1], t.v[k][2]}; }
Corner key(const FlatTriangle& t, int k) { return {t.v[k][0], t.v[k][1], t.v[k][2]}; }

struct Patch {
  dvec3 corner, e1, e2;
  bool is_triangle;

  double area() const { return glm::length(glm::cross(e1, e2)) * (is_triangle ? 0.5 : 1.0); }
};

// The parallelogram that triangle b completes over a's edge (k, k + 1), if it does so within rounding.
bool completes(const FlatTriangle& a, int k, const FlatTriangle& b, Patch& out) {
  const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
  for (int j = 0; j < 3; ++j) {
    if (key(b, j) != key(a, k1) || key(b, (j + 1) % 3) != key(a, k)) continue;
    // Opposite corners are a's k2 and b's; the shared edge is a diagonal.
    const dvec3 opposite = vertex(b, (j + 2) % 3);
    const dvec3 corner = vertex(a, k2), p = vertex(a, k), q = vertex(a, k1);
    const double size = std::max({std::abs(corner.x), std::abs(corner.y), std::abs(corner.z), glm::length(q - p)});
    if (glm::length((p - corner) + (q - corner) - (opposite - corner)) > 1e-6 * size) return false;
    out = {corner, p - corner, q - corner, false};
    return true;
  }
  return false;
}

std::vector<Patch> find_patches(std::span<const FlatTriangle> triangles) {
  std::map<std::pair<Corner, Corner>, size_t> by_edge;  // directed edge to the triangle that has it
  for (size_t i = 0; i < triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) by_edge[{key(triangles[i], k), key(triangles[i], (k + 1) % 3)}] = i;
  }
  std::vector<bool> used(triangles.size(), false);
  std::vector<Patch> patches;
  for (size_t i = 0; i < triangles.size(); ++i) {
    if (used[i]) continue;
    used[i] = true;
    const FlatTriangle& a = triangles[i];
    Patch patch{vertex(a, 0), vertex(a, 1) - vertex(a, 0), vertex(a, 2) - vertex(a, 0), true};
    for (int k = 0; k < 3; ++k) {
      const auto found = by_edge.find({key(a, (k + 1) % 3), key(a, k)});
      if (found == by_edge.end() || used[found->second]) continue;
      if (!completes(a, k, triangles[found->second], patch)) continue;
      used[found->second] = true;
      break;
    }
    patches.push_back(patch);
  }
  return patches;
}

void finish_light(Plan& plan, PlanLight light, const dvec3& radiance, double extent) {
  for (int k = 0; k < 3; ++k) light.radiance[k] = static_cast<float>(radiance[k]);
  light.err = static_cast<float>(kLightErrorUlps * std::numeric_limits<float>::epsilon() * extent);
  plan.lights.push_back(light);
  plan.light_table.insert(plan.light_table.end(),
                          {light.radiance[0], light.radiance[1], light.radiance[2], light.area});
}

}  // namespace

void add_mesh_light(Plan& plan, std::span<const FlatTriangle> triangles, const dvec3& radiance) {
  const std::vector<Patch> patches = find_patches(triangles);
  double area = 0, extent = 0;
  for (const Patch& p : patches) {
    area += p.area();
    for (const dvec3& v : {p.corner, p.e1, p.e2})
      extent = std::max({extent, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  }
  PlanLight light{};
  light.area = static_cast<float>(area);
  light.first_patch = static_cast<uint32_t>(plan.light_patches.size());
  light.patches = static_cast<uint32_t>(patches.size());
  double below = 0;
  for (const Patch& p : patches) {
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
    out.is_triangle = p.is_triangle ? 1.0f : 0.0f;
    plan.light_patches.push_back(out);
  }
  finish_light(plan, light, radiance, extent);
}

void add_sphere_light(Plan& plan, const FlatSphere& sphere, const dvec3& radiance) {
  PlanLight light{};
  light.area = 4 * std::numbers::pi_v<float> * sphere.radius * sphere.radius;
  light.radius = sphere.radius;
  std::copy_n(sphere.center, 3, light.center);
  const float far = std::max({std::abs(sphere.center[0]), std::abs(sphere.center[1]), std::abs(sphere.center[2])});
  finish_light(plan, light, radiance, far + sphere.radius);
}

}  // namespace lanewise
