#include "core/plan_light_paths.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <string_view>

#include "core/pixel_sums.h"
#include "kernels/reference/intersect.h"

namespace lanewise {
namespace {

using glm::dvec3;

constexpr uint64_t kPiecesPerWorker = 4, kLeastPiece = 1 << 14, kMostPiece = 1 << 17;

// Passes that paths are counted on through; and paths that share an epoch: see light_path_epoch().
constexpr uint64_t kEra = uint64_t{1} << 32, kEpoch = uint64_t{1} << 48;

double power_of(const PlanLight& light) {
  return luminance(light.radiance[0], light.radiance[1], light.radiance[2]) * light.area;
}

uint64_t paths_of_pass(const Plan& plan) {
  uint64_t paths = 0;
  for (const LampPaths& lamp : plan.lamp_paths) paths += lamp.per_pass;
  return paths;
}

dvec3 to_dvec3(const float* v) { return {v[0], v[1], v[2]}; }

// The box of some points, and a sphere about its centre.
class Hull {
 public:
  void add(const dvec3& low, const dvec3& high) { low_ = glm::min(low_, low), high_ = glm::max(high_, high); }
  // As floats have it.
  dvec3 center() const { return dvec3(glm::vec3((low_ + high_) / 2.0)); }
  // Wider than the radius by more than what rays that are aimed at it are rounded by.
  Caster around(double radius) const {
    const dvec3 c = center();
    const double slack = 1e-5 * radius + 1e-6 * (std::abs(c.x) + std::abs(c.y) + std::abs(c.z));
    return {{static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)},
            static_cast<float>(radius + slack)};
  }

 private:
  dvec3 low_{std::numeric_limits<double>::infinity()}, high_{-std::numeric_limits<double>::infinity()};
};

Caster caster_around(std::span<const FlatTriangle> triangles) {
  Hull hull;
  for (const FlatTriangle& t : triangles) {
    for (const auto& v : t.v) hull.add(to_dvec3(v), to_dvec3(v));
  }
  double radius = 0;
  for (const FlatTriangle& t : triangles) {
    for (const auto& v : t.v) radius = std::max(radius, glm::distance(hull.center(), to_dvec3(v)));
  }
  return hull.around(radius);
}

Caster caster_around(const FlatSphere& sphere) {
  Hull hull;
  hull.add(to_dvec3(sphere.center), to_dvec3(sphere.center));
  return hull.around(sphere.radius);
}

Caster caster_around(const std::vector<Caster>& casters) {
  Hull hull;
  for (const Caster& c : casters) {
    hull.add(to_dvec3(c.center) - double{c.radius}, to_dvec3(c.center) + double{c.radius});
  }
  double radius = 0;
  for (const Caster& c : casters) {
    radius = std::max(radius, glm::distance(hull.center(), to_dvec3(c.center)) + c.radius);
  }
  return hull.around(radius);
}

// A point of the lamp, about in its middle.
dvec3 middle(const Plan& plan, const PlanLight& light) {
  if (light.patches == 0) return to_dvec3(light.center);
  const LightPatch& patch = plan.light_patches[light.first_patch];
  return to_dvec3(patch.corner) + (to_dvec3(patch.e1) + to_dvec3(patch.e2)) / (patch.is_triangle != 0 ? 3.0 : 2.0);
}

double solid_angle(const Caster& caster, const dvec3& from) {
  const double distance2 = std::pow(glm::distance(to_dvec3(caster.center), from), 2);
  const double sine2 = double{caster.radius} * caster.radius / distance2;
  return 2 * std::numbers::pi * (sine2 < 1 ? sine2 / (1 + std::sqrt(1 - sine2)) : 2);
}

bool in_use(const Plan& plan, uint32_t bin) {
  return std::ranges::any_of(plan.prim_bin, [&](uint32_t b) { return b == bin; });
}

// Of the area of a box around the scene, about how much of diffuse surfaces the picture shows, by some rays.
float share_shown(const Plan& plan, const dvec3& size) {
  constexpr uint32_t kRays = 12;  // each way
  const dvec3 eye = to_dvec3(plan.camera.eye), forward = to_dvec3(plan.camera.forward);
  const dvec3 right = to_dvec3(plan.camera.right), up = to_dvec3(plan.camera.up);
  const double width = plan.settings.width, height = plan.settings.height, pixel = plan.camera.pixel;
  double shown = 0;
  for (uint32_t k = 0; k < kRays * kRays; ++k) {
    const double x = ((k % kRays + 0.5) / kRays - 0.5) * width, y = ((k / kRays + 0.5) / kRays - 0.5) * height;
    const dvec3 d = glm::normalize(forward + pixel * (x * right + y * up));
    const auto hit = reference::closest_hit(plan, eye, d);
    if (!std::isfinite(hit.t) || plan.prim_bin[hit.prim] != kDiffuse) continue;
    const float* shape = &plan.prim_shape[4 * size_t{hit.prim}];
    const dvec3 n = hit.prim < plan.triangles ? to_dvec3(shape) : glm::normalize(eye + hit.t * d - to_dvec3(shape));
    const double cosine = glm::dot(d, forward), side = pixel * hit.t * cosine;
    shown += side * side * cosine / std::max(0.05, std::abs(glm::dot(d, n)));
  }
  const double area = 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
  return static_cast<float>(shown * width * height / (kRays * kRays) / area);
}

}  // namespace

const char* why_no_light_paths(const Plan& plan) {
  const Settings& settings = plan.settings;
  if (!settings.light_paths) return "--light-paths off";
  if (settings.direct != Direct::kMis) return "only with --direct mis";
  if (settings.adaptive_batch > 0 || settings.noise > 0) return "-a and --noise stop pixels one by one";
  if (settings.course.any() || settings.fresnel == Fresnel::kCourse)
    return "the course program's formulas are not reciprocal";
  if (settings.max_depth < 2 || (settings.only_bounce && *settings.only_bounce < 2))
    return "no path of two scattering events";
  if (std::ranges::none_of(plan.lights, [](const PlanLight& light) { return power_of(light) > 0; })) return "no lamp";
  if (!in_use(plan, kDiffuse)) return "no diffuse surface";
  if (std::ranges::none_of(plan.prim_bin, casts)) return "only diffuse surfaces";
  if (plan.shown < kLeastShown) return "the picture shows too little of diffuse surfaces";
  return "";
}

void choose_light_paths(Plan& plan, std::span<const FlatTriangle> triangles, std::span<const FlatSphere> spheres) {
  if (!std::string_view(why_no_light_paths(plan)).empty()) return;
  for (const PlanGroup& group : plan.groups) {
    if (group.first >= plan.triangles || group.size == 0 || !casts(plan.prim_bin[group.first])) continue;
    plan.casters.push_back(caster_around(triangles.subspan(group.first, group.size)));
  }
  for (const FlatSphere& sphere : spheres) {
    if (casts(plan.prim_bin[sphere.prim])) plan.casters.push_back(caster_around(sphere));
  }
  if (plan.casters.size() > kMaxCasters) plan.casters = {caster_around(plan.casters)};

  std::vector<double> angles;  // of all casters, from each lamp
  double power = 0;            // that goes there
  for (const PlanLight& light : plan.lights) {
    angles.push_back(0);
    for (const Caster& caster : plan.casters) angles.back() += solid_angle(caster, middle(plan, light));
    power += power_of(light) * angles.back();
  }
  const double all = std::ceil(static_cast<double>(plan.settings.width) * plan.settings.height / kPixelsPerLightPath);
  for (size_t i = 0; i < plan.lights.size(); ++i) {
    const PlanLight& light = plan.lights[i];
    const double share = power_of(light) * angles[i] / power;
    LampPaths paths;
    if (share > 0) {  // a lamp that is switched off sends out none
      const float brightest = std::max({light.radiance[0], light.radiance[1], light.radiance[2]});
      paths.per_pass = static_cast<uint32_t>(std::max(1.0, std::round(all * share)));
      paths.throughput = static_cast<float>(1 / angles[i]);
      paths.scale = static_cast<float>(double{brightest} * light.area * angles[i] / paths.per_pass);
    }
    plan.lamp_paths.push_back(paths);
  }
}

void drop_unseen_light_paths(Plan& plan, const dvec3& size) {
  if (!has_light_paths(plan)) return;
  plan.shown = share_shown(plan, size);
  if (plan.shown >= kLeastShown) return;
  plan.casters.clear();
  plan.lamp_paths.clear();
}

std::vector<LightPiece> light_pieces(const Plan& plan, uint64_t first_pass, uint64_t passes, uint32_t workers) {
  const uint64_t paths =
      std::clamp(passes * paths_of_pass(plan) / (kPiecesPerWorker * workers), kLeastPiece, kMostPiece);
  std::vector<LightPiece> pieces;
  while (passes > 0) {
    const uint64_t pass = first_pass % kEra, some = std::min(passes, kEra - pass);
    for (uint32_t light = 0; light < plan.lamp_paths.size(); ++light) {
      const uint64_t per_pass = plan.lamp_paths[light].per_pass, end = (pass + some) * per_pass;
      for (uint64_t first = pass * per_pass; first < end; first += pieces.back().count) {
        const uint64_t count = std::min({paths, end - first, kEpoch - first % kEpoch});
        pieces.push_back({light, static_cast<uint32_t>(count), first, light_path_epoch(light, first, first_pass)});
      }
    }
    first_pass += some;
    passes -= some;
  }
  return pieces;
}

uint64_t passes_at_a_time(const Plan& plan, uint32_t workers) {
  return std::max<uint64_t>(1, kPiecesPerWorker * workers * kMostPiece / paths_of_pass(plan));
}

}  // namespace lanewise
