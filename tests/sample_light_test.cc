#include "kernels/reference/sample_light.h"

#include <doctest/doctest.h>

#include "tests/kernel_harness.h"
#include "core/verify/test_scene.h"

namespace lanewise {
namespace {

void check_light(const Plan& plan, uint32_t light) {
  test::check_kernel(plan, "sample_light", {.bounce = 1, .light = light, .light_sample = 1});
}

// A scene whose first light is a fan of triangles of different sizes.
Scene fan_scene() {
  Scene scene = test::test_box();
  Mesh& light = scene.meshes[5];
  light.positions = {{0, 0, 1.4}, {0.4, 0, 1.4}, {0.3, 0.3, 1.4}, {0, 0.2, 1.4}, {-0.5, 0.4, 1.4}, {-0.2, -0.3, 1.4}};
  light.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 4, 3}, {0, 5, 4}, {0, 1, 5}};
  return scene;
}

}  // namespace

TEST_CASE("sample_light: SIMD against its twin for a parallelogram, a triangle, many patches, a sphere") {
  Settings settings;
  settings.light_samples = 2;
  const Plan plan = test::test_plan(settings);
  REQUIRE(plan.lights.size() == 2);
  CHECK(plan.lights[0].patches == 1);
  CHECK(plan.light_patches[0].is_triangle == 0);
  CHECK(plan.light_patches[1].is_triangle == 1);
  check_light(plan, 0);
  check_light(plan, 1);

  const Plan fan = make_plan(fan_scene(), settings);
  CHECK(fan.lights[0].patches == 5);
  check_light(fan, 0);

  Scene scene = test::test_box();
  scene.spheres[2].material = test::kSmallLight;
  const Plan sphere = make_plan(scene, settings);
  check_light(sphere, 2);
}

}  // namespace lanewise
