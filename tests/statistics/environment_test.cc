// Light from an environment map: its samples against their density, and pictures against what is known of them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "core/render.h"
#include "core/verify/test_scene.h"
#include "kernels/reference/environment_map.h"
#include "tests/kernel_harness.h"
#include "tests/statistics/chi_square.h"
#include "tests/statistics/known_pixels.h"
#include "tests/statistics/renders.h"

TEST_SUITE_BEGIN("statistics");

namespace lanewise {
namespace {

using glm::dvec3;
using std::numbers::pi;

constexpr Direct kAllDirect[] = {Direct::kMis, Direct::kLight, Direct::kBsdf, Direct::kHemisphere};

std::string named(Direct direct) { return "direct " + std::to_string(static_cast<int>(direct)); }

Image constant_sky(float radiance) {
  Image sky(1, 1);
  sky.rgb = {radiance, radiance, radiance};
  return sky;
}

Image lighter(Image sky) {
  for (float& x : sky.rgb) x += 0.05f;
  return sky;
}

Scene under(const Image& sky) {
  Scene scene;
  scene.path = "under the sky";
  scene.environment = sky;
  return scene;
}

Mesh quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
  Mesh mesh;
  mesh.positions = {a, b, c, d};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

// Irradiance on a floor of normal +z from the directions that are seen, per channel: the midpoint rule.
dvec3 irradiance(const EnvironmentMap& map, const std::function<bool(const dvec3&)>& seen) {
  constexpr int kRows = 600, kColumns = 1200;
  dvec3 sum(0);
  for (int j = 0; j < kRows; ++j) {
    const double theta = pi / 2 * (j + 0.5) / kRows, r = std::sin(theta), z = std::cos(theta);
    for (int i = 0; i < kColumns; ++i) {
      const double phi = 2 * pi * (i + 0.5) / kColumns;
      const dvec3 d(r * std::cos(phi), r * std::sin(phi), z);
      if (seen(d)) sum += r * z * reference::sky_along(map, d).radiance;
    }
  }
  return sum * (pi / 2 / kRows * 2 * pi / kColumns);
}

// Where a direction lies, in cells: x from the left, y from the top.
glm::dvec2 place_of(const EnvironmentMap& map, const dvec3& d) {
  double x = (0.5 - reference::atan2_turns(d.y, d.x)) * map.width - 0.5;
  if (x < 0) x += map.width;
  return {x, reference::sky_row(map, std::hypot(d.x, d.y), d.z)};
}

}  // namespace

TEST_CASE("chi-square: directions to the environment, on every target") {
  constexpr uint32_t kSkyDraws = std::max(test::kDraws / 4, 1u << 15);  // for cells that are met seldom
  test::Family family;
  test::for_each_target([&](const char* target) {
    for (const bool one_texel : {false, true}) {
      Scene scene = under(one_texel ? constant_sky(1) : lighter(test::test_sky()));
      scene.materials = {test::diffuse(dvec3(0.5))};
      scene.spheres = {{"ball", dvec3(0), 1, 0}};
      scene.cameras = {Camera()};
      const Plan plan = make_plan(scene, {});
      const EnvironmentMap& map = plan.environment;
      // Over the picture in cells, of which the first and the last row are half as high; cut twice across and, for edges of
      // cells to be edges of the test's, twice along.
      const auto density = [&](double x, double y) {
        if (y < 0.5 || y > map.height + 0.5) return 0.0;
        const size_t cell =
            static_cast<size_t>(y) * (map.width + 1) + std::min<size_t>(static_cast<size_t>(x), map.width - 1);
        return map.texels[cell].pdf * std::sin(pi * (y - 0.5) / map.height) * 2 * pi / map.width * pi / map.height;
      };
      const double width = map.width, height = map.height + 1.0;
      const uint32_t cut = one_texel ? 16 : 2;
      test::ChiSquare test({{0, width}, {0, height}, cut * map.width, cut * (map.height + 1), density});
      uint32_t beside = 0;
      bool reaches = true;
      test::for_each_draw(sample_environment, plan, {}, kSkyDraws, [&](const PathState& s, uint32_t i) {
        const dvec3 l(s.l_x[i], s.l_y[i], s.l_z[i]);
        const glm::dvec2 at = place_of(map, l);
        test.add(std::clamp(at.x, 0.0, width), std::clamp(at.y, 0.5, height - 0.5));
        beside += static_cast<float>(reference::sky_along(map, l).pdf) != s.l_pdf[i];
        reaches &= std::abs(glm::length(l) / map.reach - 1) < 1e-6;
      });
      CHECK(reaches);
      CHECK(beside < kSkyDraws / 1000);  // sent to the next cell by rounding
      family.add(std::string(target) + (one_texel ? " one texel" : " sky"), test.p());
    }
  });
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

TEST_CASE("environment: what the camera sees of it, directly and in a mirror, lies where the map says") {
  const auto check = [](Scene scene, const dvec3& eye, const dvec3& target, const dvec3& seen, double tint) {
    scene.cameras = {test::look(eye, target, 2e-5)};
    Settings settings = test::small_picture();
    settings.spp = 1, settings.max_depth = 1;
    const Plan plan = make_plan(scene, settings);
    const dvec3 want = tint * reference::sky_along(plan.environment, seen).radiance;
    test::for_each_target([&](const char* name) {
      CAPTURE(name);
      const Image image = render(plan).image;
      double worst = 0;
      for (size_t i = 0; i < image.rgb.size(); ++i) {
        worst = std::max(worst, std::abs(image.rgb[i] - want[static_cast<int>(i % 3)]));
      }
      CHECK(worst < 2e-3 * glm::length(want) + 1e-6);
    });
  };
  Scene scene = under(test::test_sky());
  Material mirror;
  mirror.kind = Material::Kind::kMirror;
  mirror.reflectance = dvec3(0.9);
  scene.materials = {mirror};
  scene.spheres = {{"ball", dvec3(0), 1, 0}};
  const double sun_u = 5.5 / 24, sun_v = 3.5 / 12;
  const dvec3 sun(std::sin(pi * sun_v) * std::cos(pi * (1 - 2 * sun_u)),
                  std::sin(pi * sun_v) * std::sin(pi * (1 - 2 * sun_u)), std::cos(pi * sun_v));
  for (const dvec3& d : {sun, dvec3(0, 0, 1), dvec3(0.1, -0.2, -1), dvec3(-1, 1e-3, 0.2), dvec3(-1, -1e-3, 0.2),
                         dvec3(0.3, -0.8, 0.4), dvec3(0.5, 0.5, -0.9)}) {
    check(scene, 3.0 * glm::normalize(d), 5.0 * glm::normalize(d), glm::normalize(d), 1);
    // From a point from which the ray into the ball's point n comes back along d.
    const dvec3 n = glm::normalize(glm::normalize(d) + glm::normalize(dvec3(0.5, 0.4, 0.7)));
    const dvec3 back = 2 * glm::dot(n, glm::normalize(d)) * n - glm::normalize(d);
    check(scene, n + 2.0 * back, n, glm::normalize(d), 0.9);
  }
}

TEST_CASE("environment: a ball of albedo a alone under a sky of radiance 1 shows a; at -m 0 it is black") {
  test::Family family;
  for (const Direct direct : kAllDirect) {
    Scene scene = under(constant_sky(1));
    scene.materials = {test::diffuse({0.75, 0.5, 0.25})};
    scene.spheres = {{"ball", dvec3(0), 1, 0}};
    scene.cameras = {test::look({0, -3, 0.5}, {0, 0, 0.2}, 0.1)};
    Settings settings = test::small_picture();
    settings.direct = direct, settings.max_depth = 1, settings.light_samples = 2, settings.seed = family.tests();
    const Image image = render(make_plan(scene, settings)).image;
    for (size_t k = 0; k < 3; ++k) family.add(named(direct), test::pixels_p(image, k, 0.25 * double(3 - k)));
    settings.max_depth = 0;
    const Image dark = render(make_plan(scene, settings)).image;
    CHECK(std::ranges::all_of(dark.rgb, [](float x) { return x == 0; }));
  }
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

TEST_CASE("environment: a white corner under a sky of radiance 1 vanishes in it, as every path leaves it in the end") {
  test::Family family;
  for (const Direct direct : kAllDirect) {
    Scene scene = under(constant_sky(1));
    scene.materials = {test::diffuse(dvec3(1))};
    scene.meshes = {quad({0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}), quad({0, 0, 0}, {0, 0, 2}, {2, 0, 2}, {2, 0, 0}),
                    quad({0, 0, 0}, {0, 2, 0}, {0, 2, 2}, {0, 0, 2})};
    scene.cameras = {test::look({1.5, 1.2, 1}, {0.3, 0.2, 0.1}, 0.6)};
    Settings settings = test::small_picture();
    settings.direct = direct, settings.max_depth = 100, settings.seed = family.tests();
    family.add(named(direct), test::pixels_p(render(make_plan(scene, settings)).image, 1, 1));
  }
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

TEST_CASE(
    "environment: a floor shows the irradiance of the sky that it sees, in the open and beside a roof on the hull") {
  test::Family family;
  constexpr double kFar = 100;
  for (const bool roof : {false, true}) {
    Scene scene = under(test::test_sky());
    scene.materials = {test::diffuse(dvec3(0.6))};
    scene.meshes = {quad({-kFar, -kFar, 0}, {kFar, -kFar, 0}, {kFar, kFar, 0}, {-kFar, kFar, 0})};
    // Over all that is on one side of the point looked at.
    if (roof) scene.meshes.push_back(quad({-kFar, -kFar, 1}, {0, -kFar, 1}, {0, kFar, 1}, {-kFar, kFar, 1}));
    scene.cameras = {test::look({0.3, -0.4, 0.2}, {0, 0, 0}, 1e-3)};
    for (const Direct direct : kAllDirect) {
      Settings settings = test::small_picture();
      settings.direct = direct, settings.max_depth = 1, settings.seed = 7 + family.tests();
      const Plan plan = make_plan(scene, settings);
      const dvec3 light = irradiance(plan.environment, [&](const dvec3& d) { return !roof || d.x > 0; });
      const Image image = render(plan).image;
      for (int k = 0; k < 3; k += 2) {
        family.add(named(direct) + (roof ? " beside a roof" : ""),
                   test::pixels_p(image, static_cast<size_t>(k), 0.6 / pi * light[k]));
      }
    }
  }
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

TEST_CASE("environment: pictures of every estimator agree with the reference in double precision") {
#ifdef NDEBUG
  constexpr uint32_t kSeeds = 8, kSpp = 16;
#else
  constexpr uint32_t kSeeds = 4, kSpp = 4;
#endif
  Settings settings = test::small_picture();
  settings.width = 48, settings.height = 36, settings.spp = kSpp, settings.max_depth = 3;
  settings.lens_radius = 0.05, settings.focal_distance = 3.5;
  Plan plan = make_plan(test::test_outdoors(), settings);
  test::Family means;
  const std::vector<Image> want = test::independent_renders(plan, test::reference, 1000, kSeeds);
  for (const Direct direct : kAllDirect) {
    plan.settings.direct = direct;
    const test::Unpaired unpaired =
        test::compare_unpaired(test::independent_renders(plan, test::simd, 1, kSeeds), want, 6);
    CAPTURE(named(direct));
    // Where chance must find the sun, few pixels of some samples know their variance.
    if (direct != Direct::kBsdf && direct != Direct::kHemisphere) CHECK(unpaired.pixels_passed >= 0.9975);
    means.add(named(direct), unpaired.mean_p);
  }
  CHECK_MESSAGE(means.holds(), means.least_likely());
  // Of the same seeds, where only rounding differs.
  plan.settings.direct = Direct::kMis;
  const test::Paired paired = test::compare_paired(test::independent_renders(plan, test::simd, 1000, kSeeds), want);
  CHECK(paired.differing < 0.03);
  CHECK(std::abs(paired.difference) < 4 * paired.error + 1e-6);
}

}  // namespace lanewise

TEST_SUITE_END();
