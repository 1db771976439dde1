// Light paths bring as much light as paths from the camera that look for it by themselves, to every part of the picture.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "core/plan_light_paths.h"
#include "core/scene.h"
#include "core/verify/test_scene.h"
#include "tests/statistics/two_estimators.h"

TEST_SUITE_BEGIN("statistics");

namespace lanewise {
namespace {

using test::kEnough;
using test::settings_of;

// With light paths, and by paths from the camera alone.
test::Difference compare(const Scene& scene, Settings settings) {
  const Plan with = make_plan(scene, settings);
  REQUIRE(has_light_paths(with));
  settings.light_paths = false;
  return test::compare(with, make_plan(scene, settings));
}

}  // namespace

TEST_CASE("light paths: as bright as paths from the camera, for mirrors, glass and metal, at every depth") {
  test::Family means;
  double ratios = 1;  // a few bright paths are the variance of a few pictures: all depths together
  for (const uint32_t depth : {2u, 3u, 5u, 9u}) {
    const test::Difference d = compare(test::test_scene(), settings_of(depth));
    test::check_blocks(means, "scene at -m " + std::to_string(depth), d);
    if (depth > 2) ratios *= d.variance_ratio;
  }
  if (kEnough) CHECK(std::cbrt(ratios) > 1.2);
  for (const double alpha : {0.02, 0.1, 0.5, 1.0}) {
    Scene scene = test::test_box();
    for (Sphere& sphere : scene.spheres) sphere.material = test::kGold;
    scene.materials[test::kGold].alpha = alpha;
    test::check_blocks(means, "alpha " + std::to_string(alpha), compare(scene, settings_of(5)));
  }
  CHECK_MESSAGE(means.holds(), means.least_likely());
}

TEST_CASE(
    "light paths: as bright by lamps that are spheres or within glass, through rough glass, and where casters "
    "overlap") {
  test::Family means;
  Scene lamp = test::test_box();
  lamp.spheres[2].material = test::kSmallLight;
  test::check_blocks(means, "sphere lamp", compare(lamp, settings_of(5)));

  // Nothing else lights the box: all that it gets comes out of the glass.
  Scene bulb = test::test_box();
  const glm::dvec3 center(0, 0, 0.8);
  bulb.spheres = {{"glass", center, 0.3, test::kGlassMaterial}, {"lamp", center, 0.1, test::kSmallLight}};
  std::erase_if(bulb.meshes, [](const Mesh& m) { return m.material == test::kCeilingLight; });
  test::check_blocks(means, "bulb", compare(bulb, settings_of(5)));

  Scene rough = test::test_box();
  rough.materials[test::kGlassMaterial].roughness = 0.2;
  rough.materials[test::kGlassMaterial].transmittance = {0.8, 0.9, 1};
  test::check_blocks(means, "rough glass", compare(rough, settings_of(5)));

  Scene overlapping = test::test_box();
  overlapping.spheres = {{"a", {-0.2, 0, 0.5}, 0.3, test::kMirrorMaterial},
                         {"b", {0.1, 0.1, 0.5}, 0.3, test::kGold},
                         {"around", {0, 0, 0.75}, 0.2, test::kGlassMaterial}};
  test::check_blocks(means, "overlapping", compare(overlapping, settings_of(4)));
  CHECK_MESSAGE(means.holds(), means.least_likely());
}

TEST_CASE(
    "light paths: as bright where corner normals differ from faces, on metal, mirror, glass and what they light") {
  test::Family means;
  for (const uint32_t material : {test::kGold, test::kMirrorMaterial, test::kGlassMaterial, test::kWhite}) {
    Scene scene = test::test_scene();
    for (Mesh& mesh : scene.meshes) {
      if (mesh.triangles.size() > 16) mesh.material = material;  // the one with smooth normals
    }
    test::check_blocks(means, "material " + std::to_string(material), compare(scene, settings_of(5)));
  }
  CHECK_MESSAGE(means.holds(), means.least_likely());
}

TEST_CASE("light paths: as bright by a lens, on textures, under a sky, and of one bounce alone") {
  test::Family means;
  Settings lens = settings_of(5);
  lens.lens_radius = 0.08, lens.focal_distance = 2.5;
  test::check_blocks(means, "lens", compare(test::test_scene(), lens));
  Settings bounce = settings_of(5);
  bounce.only_bounce = 3;
  test::check_blocks(means, "bounce 3", compare(test::test_scene(), bounce));
  Settings samples = settings_of(4);
  samples.light_samples = 3;
  test::check_blocks(means, "three light samples", compare(test::test_scene(), samples));
  test::check_blocks(means, "sky", compare(test::test_outdoors(), settings_of(4)));
  CHECK_MESSAGE(means.holds(), means.least_likely());
}

}  // namespace lanewise

TEST_SUITE_END();
