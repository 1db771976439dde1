// Scenes whose pixels are known: Student's test of all of a picture's pixels, which expect the same (as in nori).
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "core/render.h"
#include "scenes/load.h"
#include "tests/kernel_harness.h"
#include "tests/scene_paths.h"
#include "tests/shading_harness.h"
#include "tests/statistics/known_pixels.h"
#include "tests/statistics/lobes.h"

TEST_SUITE_BEGIN("statistics");

namespace lanewise {
namespace {

using glm::dvec3;
using std::numbers::pi;

using test::diffuse;
using test::look;
using test::pixels_p;

Material emitter(double radiance) {
  Material m;
  m.kind = Material::Kind::kEmission;
  m.radiance = dvec3(radiance);
  return m;
}

// A lamp of this radius in the middle of a diffuse sphere of radius 1, lighting it with irradiance pi; seen from between
// them, facing the wall.
constexpr double kLampRadius = 0.2;
Scene furnace(const dvec3& albedo) {
  Scene scene;
  scene.path = "furnace";
  scene.materials = {diffuse(albedo), emitter(1 / (kLampRadius * kLampRadius))};
  scene.spheres = {{"wall", dvec3(0), 1, 0}, {"lamp", dvec3(0), kLampRadius, 1}};
  scene.cameras = {look({0.5, 0, 0}, {1, 0, 0}, 0.8)};
  return scene;
}

// The wall's radiance after at most `depth` scatterings: it sees itself but for the share that the lamp hides.
double wall_radiance(double albedo, uint32_t depth) {
  double sum = 0, scattered = albedo;
  for (uint32_t k = 0; k < depth; ++k) {
    sum += scattered;
    scattered *= albedo * (1 - kLampRadius * kLampRadius);
  }
  return sum;
}

// scenes/furnace.dae, where light of radiance 1 comes from everywhere, with another ball, looked at in one point at this
// angle: all the pixels see it alike.
Scene ball_in_furnace(const Material& ball, double degrees) {
  Scene scene = load_scene(test::shipped_scene("furnace.dae").string());
  const uint32_t material = scene.spheres[0].material;
  scene.materials[material] = ball;
  const double x = std::sin(degrees * pi / 180);
  scene.cameras = {look({x, -3.5, 0}, {x, 0, 0}, 1e-3)};
  return scene;
}

// Lambert's formula: irradiance on a surface with normal n at p from a polygon of radiance 1 that is wholly above it, its
// corners counter-clockwise as seen from p.
double polygon_irradiance(const dvec3& p, const dvec3& n, const std::vector<dvec3>& corners) {
  double sum = 0;
  for (size_t i = 0; i < corners.size(); ++i) {
    const dvec3 a = glm::normalize(corners[i] - p), b = glm::normalize(corners[(i + 1) % corners.size()] - p);
    sum += std::acos(glm::clamp(glm::dot(a, b), -1.0, 1.0)) * glm::dot(glm::normalize(glm::cross(b, a)), n);
  }
  return sum / 2;
}

// A diffuse floor at z = 0 under a polygon of radiance 1 that faces down, looked at in one point.
constexpr double kFloorAlbedo = 0.6;
Scene floor_under(const std::vector<dvec3>& corners, const dvec3& point) {
  Scene scene;
  scene.path = "floor";
  scene.materials = {diffuse(dvec3(kFloorAlbedo)), emitter(1)};
  Mesh floor, light;
  floor.positions = {{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}};
  floor.triangles = {{0, 1, 2}, {0, 2, 3}};
  light.positions = corners;
  light.material = 1;
  for (uint32_t i = 2; i < corners.size(); ++i) light.triangles.push_back({0, i - 1, i});
  scene.meshes = {floor, light};
  scene.cameras = {look(point + dvec3(0.3, -0.4, 0.2), point, 1e-3)};
  return scene;
}

// Counter-clockwise as seen from below.
const std::vector<std::pair<const char*, std::vector<dvec3>>> kPolygons = {
    {"parallelogram", {{-0.5, -0.4, 1}, {-0.3, 0.6, 1}, {0.7, 0.6, 1}, {0.5, -0.4, 1}}},
    {"triangle", {{-0.5, -0.4, 1.5}, {-0.2, 0.8, 1}, {0.6, 0.1, 0.8}}},
    {"pentagon", {{-0.4, -0.5, 0.9}, {-0.7, 0.2, 0.9}, {0, 0.7, 0.9}, {0.7, 0.2, 0.9}, {0.3, -0.6, 0.9}}},
};
const dvec3 kPoints[] = {{0, 0, 0}, {0.9, -0.6, 0}, {-1.5, 1, 0}};

}  // namespace

TEST_CASE("furnace: walls of albedo a around a lamp reach a / (1 - a), at every depth") {
  test::Family family;
  const dvec3 albedos[] = {{0.5, 0.75, 0.9}, {0.25, 0.95, 0.1}};
  for (const dvec3& albedo : albedos) {
    Plan plan = make_plan(furnace(albedo), test::small_picture());
    for (const uint32_t depth : {0u, 1u, 2u, 3u, 4u, 5u, 100u}) {
      plan.settings.max_depth = depth;
      plan.settings.seed = family.tests();
      const Image image = render(plan).image;
      for (int k = 0; k < 3; ++k) {
        family.add("albedo " + std::to_string(albedo[k]) + " at -m " + std::to_string(depth),
                   pixels_p(image, static_cast<size_t>(k), wall_radiance(albedo[k], depth)));
      }
    }
  }
  // With a small lamp all this is nori's 1 / (1 - a), but for the light seen directly.
  CHECK(wall_radiance(0.5, 100) == doctest::Approx(0.5 / (1 - 0.5)).epsilon(0.05));
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

TEST_CASE("furnace: every estimator of direct light agrees on the answer") {
  test::Family family;
  for (const Direct direct : {Direct::kMis, Direct::kLight, Direct::kBsdf, Direct::kHemisphere}) {
    Settings settings = test::small_picture();
    settings.direct = direct;
    settings.seed = 7 + family.tests();
    settings.light_samples = 2;
    const Image image = render(make_plan(furnace(dvec3(0.75, 0.5, 0.25)), settings)).image;
    family.add("direct " + std::to_string(int(direct)), pixels_p(image, 0, wall_radiance(0.75, settings.max_depth)));
  }
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

TEST_CASE("white furnace: mirror, glass and white diffuse vanish, metal shows its directional albedo") {
  test::Family family;
  Material mirror, glass, metal;
  mirror.kind = Material::Kind::kMirror;
  glass.kind = Material::Kind::kGlass;
  metal.kind = Material::Kind::kMicrofacet;
  mirror.reflectance = glass.reflectance = dvec3(1);
  metal.eta = metal.k = dvec3(0);  // reflects all
  Settings settings = test::small_picture();
  settings.max_depth = 100;
  const auto add = [&](const std::string& name, const Material& ball, double degrees, double mean) {
    settings.seed = family.tests();
    const Image image = render(make_plan(ball_in_furnace(ball, degrees), settings)).image;
    family.add(name + " at " + std::to_string(degrees) + " degrees", pixels_p(image, 0, mean));
  };
  for (const double degrees : {0.0, 40.0, 75.0}) {
    add("mirror", mirror, degrees, 1);
    add("glass", glass, degrees, 1);
    add("diffuse", diffuse(dvec3(1)), degrees, 1);
    add("grey", diffuse({0.75, 0.5, 0.25}), degrees, 0.75);
    const test::lobes::Vec wo(std::sin(degrees * pi / 180), 0, std::cos(degrees * pi / 180));
    for (const double alpha : {1e-3, 0.2, 0.7}) {
      metal.alpha = alpha;
      const double albedo = test::integrate(test::lobes::lobe(wo, alpha, [&](const test::lobes::Vec& wi) {
        return test::lobes::evaluate(BsdfSampling::kVndf, wo, wi, alpha).f_cos;
      }));
      for (const BsdfSampling sampling : {BsdfSampling::kVndf, BsdfSampling::kNdf}) {
        settings.bsdf_sampling = sampling;
        add("metal of alpha " + std::to_string(alpha), metal, degrees, albedo);
      }
    }
  }
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

TEST_CASE("form factors: pixels under polygon lights show Lambert's irradiance") {
  test::Family family;
  for (const auto& [name, corners] : kPolygons) {
    for (const dvec3& point : kPoints) {
      for (const Direct direct : {Direct::kMis, Direct::kLight, Direct::kBsdf, Direct::kHemisphere}) {
        Settings settings = test::small_picture();
        settings.direct = direct;
        settings.max_depth = 1;
        settings.seed = family.tests();
        const Image image = render(make_plan(floor_under(corners, point), settings)).image;
        const double irradiance = polygon_irradiance(point, {0, 0, 1}, corners);
        CHECK(irradiance > 0);
        family.add(std::string(name) + ", direct " + std::to_string(int(direct)),
                   pixels_p(image, 1, kFloorAlbedo / pi * irradiance));
      }
    }
  }
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

TEST_CASE("form factors: cos / pdf of light points is Lambert's irradiance, on every target; and a sphere's") {
  test::Family family;
  test::for_each_target([&](const char* target) {
    for (const dvec3& point : kPoints) {
      const auto add = [&](const std::string& name, const Scene& scene, double irradiance) {
        Settings settings = test::small_picture();
        settings.seed = family.tests();
        const Plan plan = make_plan(scene, settings);
        Path<float> path;
        path.o_x = static_cast<float>(point.x - plan.center[0]);
        path.o_y = static_cast<float>(point.y - plan.center[1]), path.o_z = static_cast<float>(-plan.center[2]);
        path.n_z = 1;
        test::Moments sample;
        test::for_each_draw(sample_light, plan, path, test::kDraws / 8, [&](const PathState& s, uint32_t i) {
          const dvec3 l(s.l_x[i], s.l_y[i], s.l_z[i]);
          sample.add(s.l_pdf[i] > 0 ? std::max(l.z, 0.0) / glm::length(l) / s.l_pdf[i] : 0);
        });
        family.add(std::string(target) + ' ' + name, test::t_test_p(sample, irradiance, 1e-5 * irradiance));
      };
      for (const auto& [name, corners] : kPolygons) {
        add(name, floor_under(corners, point), polygon_irradiance(point, {0, 0, 1}, corners));
      }
      Scene ball = floor_under(kPolygons[0].second, point);
      ball.meshes.pop_back();
      ball.spheres = {{"ball", {0.1, 0.2, 0.8}, 0.3, 1}};
      const dvec3 to = ball.spheres[0].center - point;
      const double distance = glm::length(to);
      add("sphere", ball, pi * 0.3 * 0.3 / (distance * distance) * to.z / distance);
    }
  });
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

}  // namespace lanewise

TEST_SUITE_END();
