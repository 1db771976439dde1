#include "kernels/reference/emission.h"

#include <doctest/doctest.h>

#include "tests/kernel_harness.h"
#include "core/verify/test_scene.h"

namespace lanewise {
TEST_CASE("emission: SIMD against its twin in every mode of direct light") {
  for (const Direct direct : {Direct::kMis, Direct::kLight, Direct::kBsdf, Direct::kHemisphere}) {
    Settings settings;
    settings.direct = direct;
    settings.light_samples = 3;
    test::check_kernel(test::test_plan(settings), "emission");
  }
}

TEST_CASE("emission: a sphere that emits") {
  Scene scene = test::test_box();
  scene.spheres[2].material = test::kSmallLight;
  const Plan plan = make_plan(scene, {});
  test::check_kernel(plan, "emission");
}

TEST_CASE("emission: the front emits, the back is black, a camera ray has full weight") {
  const Plan plan = test::test_plan();
  const uint32_t light = [&] {
    for (uint32_t i = 0;; ++i) {
      if (plan.prim_bin[i] == kEmitter) return i;
    }
  }();
  for (const float side : {1.0f, -1.0f}) {
    Path<double> p;
    p.prim = light, p.t = 1, p.d_z = side;  // the light faces down
    p.beta_r = p.beta_g = p.beta_b = 0.5;
    reference::emission(plan, p);
    CHECK(p.L_r == (side > 0 ? 5.0 : 0.0));
  }
}

}  // namespace lanewise
