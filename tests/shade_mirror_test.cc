#include "kernels/reference/shade_mirror.h"

#include <doctest/doctest.h>

#include "tests/kernel_harness.h"
#include "tests/shading_harness.h"

namespace lanewise {
TEST_CASE("shade_mirror: SIMD against its twin") {
  test::check_kernel(test::test_plan(), "shade_mirror");
  test::check_kernel(test::test_plan(), "shade_mirror", {}, [](std::mt19937& rng, Path<float>& p) {
    const float cosines[] = {1, -1, 1.7e-4f, -1.7e-4f};
    test::arrive(rng, p, cosines[rng() % 4]);
  });
}

TEST_CASE("shade_mirror: a unit direction that makes the same angle in the same plane") {
  const Plan plan = test::material_plan({test::grey(0.5f)});
  std::mt19937 rng(1);
  for (int i = 0; i < 1000; ++i) {
    PathBuffer paths(kLanes);
    Path<float> p;
    test::fill_random(plan, rng, p, 0);
    store_path(paths.state(), 0, p);
    shade_mirror(plan, paths.state(), {0, 1});
    const Path<float> after = load_path<float>(paths.state(), 0);
    using Vec = reference::Vec3<double>;
    const Vec d(p.d_x, p.d_y, p.d_z), s(p.s_x, p.s_y, p.s_z), wi(after.d_x, after.d_y, after.d_z);
    CHECK(glm::length(wi) == doctest::Approx(1).epsilon(2.4e-7));
    CHECK(std::abs(glm::dot(wi, s) + glm::dot(d, s)) < 1e-6);
    CHECK(glm::length(glm::cross(s, wi - d)) < 1e-6);
    CHECK(after.pdf == 0);
    CHECK(after.beta_r == 0.5f * p.beta_r);
  }
}

}  // namespace lanewise
