// Light by way of spheres has the same expected picture whether it is connected or met by chance.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/plan.h"
#include "core/scene.h"
#include "core/verify/test_scene.h"
#include "tests/statistics/renders.h"

TEST_SUITE_BEGIN("statistics");

namespace lanewise {
namespace {

#ifdef NDEBUG
constexpr uint32_t kSeeds = 8, kSpp = 64;
#else
constexpr uint32_t kSeeds = 4, kSpp = 8;
#endif
// Chance meets the ball's light too seldom in assert builds' few samples for tests of blocks.
constexpr bool kEnough = kSeeds * kSpp > 64;

// A floor under a ball, and between them a light that shines up: all that the floor has of it at -m 2 comes by way of the
// ball's outside.
Scene lamp_under_ball(uint32_t ball, uint32_t floor) {
  Scene scene = test::test_box();
  scene.meshes = {scene.meshes[0], scene.meshes[5]};
  scene.meshes[0].material = floor;
  scene.meshes[1].positions = {{-0.2, -0.2, 0.05}, {0.2, -0.2, 0.05}, {0.2, 0.2, 0.05}, {-0.2, 0.2, 0.05}};
  scene.spheres = {{"ball", {0.3, 0, 0.9}, 0.4, ball}};
  scene.materials[test::kGlassMaterial].ior = 4;
  // Looks down at the floor beside the lamp, from where the ball would be seen in it.
  scene.cameras[0].to_world = {{0, -1, 0, 0}, {0.77, 0, 0.64, 0}, {-0.64, 0, 0.77, 0}, {-0.9, 0, 0.54, 1}};
  scene.cameras[0].xfov = 0.5;
  return scene;
}

Plan plan_of(const Scene& scene, uint32_t depth) {
  Settings settings;
  settings.width = 48, settings.height = 36, settings.spp = kSpp, settings.threads = 1, settings.max_depth = depth;
  settings.light_paths = false;  // which would leave connections no light
  return make_plan(scene, settings);
}

struct Difference {
  double mean_p, error;   // of the pictures' means, see test::Unpaired
  double block_p;         // the least of any block's, for as many blocks
  double variance_ratio;  // of the picture's mean, by chance over connected
};

Difference compare(Plan plan) {
  REQUIRE(!plan.connected_spheres.empty());
  const std::vector<Image> connected = test::independent_renders(plan, test::simd, 1, kSeeds);
  plan.connected_spheres.clear();
  const std::vector<Image> by_chance = test::independent_renders(plan, test::simd, 1000, kSeeds);
  // Single pixels often have no chance hit at all: blocks do.
  const test::Unpaired pictures = test::compare_unpaired(connected, by_chance, 12);
  const double least = *std::ranges::min_element(pictures.block_p), blocks = double(pictures.block_p.size());
  const auto variance = [&](const std::vector<Image>& p) {
    return test::block_moments(p, plan.settings.width)[0].variance();
  };
  return {pictures.mean_p, pictures.error, 1 - std::pow(1 - least, blocks), variance(by_chance) / variance(connected)};
}

}  // namespace

TEST_CASE("connections: as bright as by chance, and far calmer, where all light comes by way of a ball") {
  test::Family means;
  for (const auto& [ball, name] : {std::pair{test::kMirrorMaterial, "mirror"}, {test::kGlassMaterial, "glass"}}) {
    for (const Direct direct : {Direct::kMis, Direct::kLight}) {
      CAPTURE(name);
      Plan plan = plan_of(lamp_under_ball(ball, test::kWhite), 2);
      plan.settings.direct = direct;
      plan.settings.light_samples = direct == Direct::kMis ? 1 : 2;
      const Difference d = compare(plan);
      if (kEnough) CHECK(d.block_p > 0.001);
      if (kEnough) CHECK(d.error < 0.05);
      CHECK(d.variance_ratio > 20);
      means.add(name, d.mean_p);
    }
  }
  CHECK_MESSAGE(means.holds(), means.least_likely());
}

TEST_CASE("connections: from metals whose lobe is wider than the light's image, and narrower") {
  test::Family means;
  for (const double alpha : {0.02, 0.05, 0.3}) {
    Scene scene = lamp_under_ball(test::kMirrorMaterial, test::kGold);
    scene.materials[test::kGold].alpha = alpha;
    const Difference d = compare(plan_of(scene, 2));
    CHECK(d.error < 0.05);
    means.add("alpha " + std::to_string(alpha), d.mean_p);
  }
  CHECK_MESSAGE(means.holds(), means.least_likely());
}

TEST_CASE("connections: several spheres and lights, deep paths, and a lamp that is a sphere") {
  test::Family means;
  Scene lamp = test::test_box();
  lamp.spheres[2].material = test::kSmallLight;
  for (const auto& [scene, name] : {std::pair{test::test_box(), "box"}, {lamp, "lamp"}}) {
    for (const uint32_t depth : {2u, 6u}) {
      const Difference d = compare(plan_of(scene, depth));
      CHECK(d.block_p > 0.001);
      means.add(name + std::string(" at -m ") + std::to_string(depth), d.mean_p);
    }
  }
  CHECK_MESSAGE(means.holds(), means.least_likely());
}

TEST_CASE("connections: no sphere is connected from where it stands around the vertex") {
  // All of the box within a mirror ball: every reflection is at its inside.
  Scene scene = test::test_box();
  scene.spheres = {{"around", {0, 0, 0.75}, 10, test::kMirrorMaterial}};
  Plan plan = plan_of(scene, 3);
  const std::vector<Image> on = test::independent_renders(plan, test::simd, 1, 1);
  plan.connected_spheres.clear();
  CHECK(on[0].rgb == test::independent_renders(plan, test::simd, 1, 1)[0].rgb);
}

}  // namespace lanewise

TEST_SUITE_END();
