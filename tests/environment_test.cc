// The environment map: where directions lie in it, how likely they are, and its kernels against their twins.
#include "kernels/reference/environment.h"

#include <doctest/doctest.h>

#include <cmath>
#include <algorithm>
#include <numbers>
#include <set>
#include <string>

#include "core/explain.h"
#include "core/image.h"
#include "core/plan_connections.h"
#include "core/types.h"
#include "core/verify/test_scene.h"
#include "tests/kernel_harness.h"

namespace lanewise {
namespace {

using Vec = reference::Vec3<double>;
using std::numbers::pi;

Image grey_map(uint32_t width, uint32_t height, float radiance) {
  Image map(width, height);
  std::ranges::fill(map.rgb, radiance);
  return map;
}

// Texels that tell themselves apart: column, row, 1.
Image numbered_map(uint32_t width, uint32_t height) {
  Image map(width, height);
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x) {
      map.pixel(x, y)[0] = static_cast<float>(x), map.pixel(x, y)[1] = static_cast<float>(y), map.pixel(x, y)[2] = 1;
    }
  }
  return map;
}

Vec direction(double u, double v) {
  const double phi = pi * (1 - 2 * u), theta = pi * v;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

// Without lights of its own.
Plan outdoor_plan(const Image& sky, const Settings& settings = {}) {
  Scene scene = test::test_outdoors();
  std::erase_if(scene.meshes, [](const Mesh& mesh) { return mesh.name == "small light"; });
  scene.environment = sky;
  return make_plan(scene, settings);
}

double solid_angle(const EnvironmentMap& map, size_t row) {
  return 2 * pi / map.width * std::abs(double{map.rows[row].below});
}

}  // namespace

TEST_CASE("environment: up is where the scene has it") {
  Scene scene = test::test_outdoors();
  scene.environment = numbered_map(8, 4);
  const Plan z_up = make_plan(scene, {});
  scene.up = {0, 1, 0};
  const Plan y_up = make_plan(scene, {});
  for (const Vec& d : {Vec(0.2, 0.3, 0.9), Vec(-0.7, 0.1, -0.2), Vec(0.4, -0.8, 0.1)}) {
    const Vec turned(d.x, d.z, -d.y);
    CHECK(reference::sky_along(y_up.environment, turned).radiance ==
          reference::sky_along(z_up.environment, d).radiance);
  }
  test::check_kernel(y_up, "environment");
  test::check_kernel(y_up, "sample_environment");
}

TEST_CASE("environment: u from the left is 1/2 - atan2(y, x) / 2 pi, v from the top acos(z) / pi") {
  const EnvironmentMap map = make_environment_map(numbered_map(8, 4), 1);
  for (uint32_t y = 0; y < 4; ++y) {
    for (uint32_t x = 0; x < 8; ++x) {
      const Vec found = reference::sky_along(map, direction((x + 0.5) / 8, (y + 0.5) / 4)).radiance;
      CHECK(glm::length(found - Vec(x, y, 1)) < 1e-12);
    }
  }
  const auto column = [&](const Vec& d) { return reference::sky_along(map, d).radiance.x; };
  CHECK(column({1, 0, 0}) == doctest::Approx(3.5));  // the middle
  CHECK(column({0, 1, 0}) == doctest::Approx(1.5));
  CHECK(column({0, -2, 0}) == doctest::Approx(5.5));      // of any length
  CHECK(column({-1, 1e-13, 0}) == doctest::Approx(3.5));  // between the last column and the first
  CHECK(column({-1, -1e-13, 0}) == doctest::Approx(3.5));
  for (const double side : {0.0, -0.0}) {
    CHECK(reference::sky_along(map, Vec(side, side, 1)).radiance.y == 0);
    CHECK(reference::sky_along(map, Vec(side, side, -1)).radiance.y == 3);
  }
}

TEST_CASE("environment: densities are chances over solid angles, and 0 exactly where the map is black") {
  Image one_texel = grey_map(9, 5, 0);
  one_texel.pixel(8, 4)[1] = 1e-30f;  // beside the seam and the lower pole
  for (const Image& picture : {test::test_sky(), grey_map(1, 1, 3), grey_map(2, 1, 1e30f), one_texel}) {
    const EnvironmentMap map = make_environment_map(picture, 1);
    REQUIRE(map.width == picture.width);
    double chances = 0, sphere = 0;
    for (uint32_t row = 0; row <= map.height; ++row) {
      for (uint32_t column = 0; column < map.width; ++column) {
        const EnvironmentMap::Texel* corner = &map.texels[size_t{row} * (map.width + 1) + column];
        chances += corner->pdf * solid_angle(map, row);
        sphere += solid_angle(map, row);
        double light = 0;
        for (const size_t offset : {size_t{0}, size_t{1}, size_t{map.width} + 1, size_t{map.width} + 2}) {
          for (const float x : corner[offset].radiance) light += double{x};
        }
        CHECK((corner->pdf > 0) == (light > 0));
      }
    }
    CHECK(sphere == doctest::Approx(4 * pi).epsilon(1e-6));
    CHECK(chances == doctest::Approx(1).epsilon(1e-6));
    CHECK(map.rows.back().cdf == 1);
  }
  CHECK(make_environment_map(grey_map(4, 2, 0), 1).empty());
  CHECK(make_environment_map(Image(), 1).empty());
}

TEST_CASE("environment: its kernels against their twins, in every mode of direct light") {
  for (const Image& sky : {test::test_sky(), grey_map(1, 1, 0.5f), numbered_map(3, 40), numbered_map(700, 2)}) {
    for (const Direct direct : {Direct::kMis, Direct::kLight, Direct::kBsdf, Direct::kHemisphere}) {
      Settings settings;
      settings.direct = direct;
      settings.light_samples = 3;
      const Plan plan = outdoor_plan(sky, settings);
      REQUIRE(sampled_lights(plan) == 1);
      test::check_kernel(plan, "environment");
      if (direct == Direct::kHemisphere) test::check_kernel(plan, "gather_emission");
      if (direct != Direct::kMis) continue;
      test::check_kernel(plan, "sample_environment", {.bounce = 1, .light = 0, .light_sample = 2});
      test::check_kernel(plan, "light_diffuse");
      test::check_kernel(plan, "light_microfacet");
      test::check_kernel(plan, "occlude");
      test::check_kernel(plan, "intersect");
    }
  }
}

TEST_CASE("environment: a ray that misses goes to the sky, one that was not traced does not") {
  const Plan plan = outdoor_plan(test::test_sky());
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    PathBuffer buffer(kLanes);
    const PathState& s = buffer.state();
    s.d_z[0] = s.d_z[1] = 1, s.o_z[0] = s.o_z[1] = 5;
    s.beta_g[0] = 1;
    intersect(plan, s, {0, 2});
    CHECK(s.bin[0] == kSky);
    CHECK(s.bin[1] == kFinished);
  });
}

TEST_CASE("environment: every face blocks the sky; without it plans are as they were") {
  Scene scene = test::test_box();
  const Plan dark = make_plan(scene, {});
  scene.environment = test::test_sky();
  const Plan lit = make_plan(scene, {});
  CHECK(dark.blocking_quads < dark.flat_quads.size());
  CHECK(lit.blocking_quads == lit.flat_quads.size());
  CHECK(lit.blocking_triangles == lit.flat_triangles.size());
  CHECK(lit.flat_slabs.size() == dark.flat_slabs.size());
  CHECK(lit.environment.reach >= 2 * std::sqrt(2 * 2 + 2 * 2 + 1.5 * 1.5));
  CHECK(dark.environment.empty());
  CHECK(dark.environment.bytes() == 0);
  CHECK(why_left_out(dark, Stage::kEnvironment) == "no environment map (-e)");
  CHECK(why_left_out(dark, Stage::kSampleEnvironment) == "no environment map (-e)");
  CHECK(why_left_out(lit, Stage::kSampleEnvironment).empty());
  const Plan sky_alone = outdoor_plan(test::test_sky());
  CHECK(why_left_out(sky_alone, Stage::kSampleLight) == "no light but the environment");
  CHECK(why_left_out(sky_alone, Stage::kConnectSphere) == "no light but the environment");
  CHECK(why_left_out(sky_alone, Stage::kSampleEnvironment).empty());
}

TEST_CASE("environment: samples of lights, of the environment and of connections draw sets of their own") {
  Settings settings;
  settings.light_samples = 3;
  Scene scene = test::test_box();
  scene.environment = test::test_sky();
  const Plan plan = make_plan(scene, settings);
  std::set<uint32_t> sets;
  for (uint32_t light = 0; light < sampled_lights(plan); ++light) {
    for (uint32_t sample = 0; sample < 3; ++sample) {
      CHECK(sets.insert(light_set(plan, {.light = light, .light_sample = sample})).second);
      if (is_environment(plan, light)) continue;
      CHECK(sets.insert(connection_set(plan, {.light = light, .light_sample = sample})).second);
    }
  }
}

TEST_CASE("environment: a scene must have a light, in it or around it") {
  Scene scene = test::test_box();
  for (Material& material : scene.materials) material.radiance = glm::dvec3(0);
  CHECK_THROWS_WITH(check_light(scene), doctest::Contains("no light"));
  scene.environment = grey_map(2, 1, 0);
  CHECK_THROWS_WITH(check_light(scene), doctest::Contains("no light"));
  scene.environment.rgb[4] = 1;
  CHECK_NOTHROW(check_light(scene));
  CHECK_NOTHROW(check_light(test::test_box()));
}

}  // namespace lanewise
