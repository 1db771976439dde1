// Paths that are used again bring as much light as paths of one pixel alone, to every part of the picture.
#include <doctest/doctest.h>

#include <string>

#include "core/path_reuse.h"
#include "core/scene.h"
#include "core/verify/test_scene.h"
#include "tests/statistics/two_estimators.h"

TEST_SUITE_BEGIN("statistics");

namespace lanewise {
namespace {

using test::settings_of;

void check(test::Family& means, const std::string& name, const Scene& scene, Settings settings) {
  const Plan with = make_plan(scene, settings);
  REQUIRE(reuses_paths(with));
  settings.reuse = false;
  test::check_blocks(means, name, test::compare(with, make_plan(scene, settings)));
}

}  // namespace

TEST_CASE("path reuse: as bright as without, at every depth, with light paths and without") {
  test::Family means;
  for (const bool light_paths : {false, true}) {
    for (const uint32_t depth : {2u, 3u, 5u, 9u}) {
      Settings settings = settings_of(depth);
      settings.light_paths = light_paths;
      check(means, "-m " + std::to_string(depth) + (light_paths ? ", light paths" : ""), test::test_scene(), settings);
    }
  }
  CHECK_MESSAGE(means.holds(), means.least_likely());
}

TEST_CASE(
    "path reuse: as bright where squares of pixels see several surfaces, near ones, and only some of what others see") {
  test::Family means;
  Scene diffuse = test::test_box();
  diffuse.spheres = {{"near", {0, -0.2, 0.35}, 0.35, test::kWhite}, {"floor", {0.3, 0.2, 0.05}, 0.05, test::kRed}};
  check(means, "diffuse spheres", diffuse, settings_of(4));
  Settings coarse = settings_of(4);
  coarse.width = 12, coarse.height = 9;  // squares as large as walls
  check(means, "coarse", test::test_scene(), coarse);
  Scene black = test::test_scene();
  black.materials[test::kRed].reflectance = {0, 0, 0};
  black.materials[test::kBlue].reflectance = {0, 0, 0.7};
  check(means, "black", black, coarse);
  Settings closer = settings_of(4);
  closer.view = View::kFit;
  check(means, "fit", test::test_scene(), closer);
  for (const uint32_t material : {test::kGold, test::kMirrorMaterial, test::kGlassMaterial, test::kWhite}) {
    Scene scene = test::test_scene();
    for (Mesh& mesh : scene.meshes) {
      if (mesh.triangles.size() > 16) mesh.material = material;  // the one with smooth normals
    }
    check(means, "material " + std::to_string(material), scene, settings_of(4));
  }
  CHECK_MESSAGE(means.holds(), means.least_likely());
}

TEST_CASE("path reuse: as bright in what the camera sees by way of mirrors, glass and metal, at every depth") {
  test::Family means;
  for (const uint32_t material : {test::kMirrorMaterial, test::kGlassMaterial, test::kGold}) {
    Scene scene = test::test_scene();
    for (Mesh& mesh : scene.meshes) {
      if (mesh.name == "back" || mesh.name == "right") mesh.material = material;
    }
    for (const bool light_paths : {false, true}) {
      for (const uint32_t depth : {3u, 5u, 9u}) {
        Settings settings = settings_of(depth);
        settings.light_paths = light_paths;
        const std::string name = "material " + std::to_string(material) + ", -m " + std::to_string(depth);
        check(means, name + (light_paths ? ", light paths" : ""), scene, settings);
      }
    }
  }
  CHECK_MESSAGE(means.holds(), means.least_likely());
}

TEST_CASE("path reuse: as bright where paths come to diffuse surfaces late, when roulette has begun") {
  test::Family means;
  Scene scene = test::test_box();
  scene.materials[test::kGlassMaterial].ior = 1.01;
  scene.materials[test::kGlassMaterial].transmittance = glm::dvec3(0.7);
  scene.spheres.clear();
  for (uint32_t panes = 1; panes <= kFirstBounces + 2; ++panes) {  // around the camera
    scene.spheres.push_back(
        {"pane", glm::dvec3(scene.cameras[0].to_world[3]), 0.2 + 0.1 * panes, test::kGlassMaterial});
    Settings settings = settings_of(panes + 2);
    settings.only_bounce = panes + 2;
    check(means, std::to_string(panes) + " panes", scene, settings);
  }
  CHECK_MESSAGE(means.holds(), means.least_likely());
}

TEST_CASE("path reuse: as bright by a lens, under a sky, of one bounce alone, and by other estimators") {
  test::Family means;
  Settings lens = settings_of(4);
  lens.lens_radius = 0.08, lens.focal_distance = 2.5;
  check(means, "lens", test::test_scene(), lens);
  check(means, "sky", test::test_outdoors(), settings_of(4));
  Settings bounce = settings_of(5);
  bounce.only_bounce = 3;
  check(means, "bounce 3", test::test_scene(), bounce);
  Settings samples = settings_of(3);
  samples.light_samples = 3;
  check(means, "three light samples", test::test_scene(), samples);
  Settings random = settings_of(3);
  random.sampler = Sampler::kRandom, random.direct = Direct::kLight;
  check(means, "random, light", test::test_scene(), random);
  CHECK_MESSAGE(means.holds(), means.least_likely());
}

}  // namespace lanewise

TEST_SUITE_END();
