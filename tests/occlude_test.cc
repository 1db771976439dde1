#include "kernels/reference/occlude.h"

#include <doctest/doctest.h>

#include <random>

#include "kernels/reference/gather_emission.h"
#include "tests/kernel_harness.h"
#include "tests/trace_plan.h"

namespace lanewise {
namespace {

using test::Ball;
using test::Keep;
using test::Triangle;

}  // namespace

TEST_CASE("occlude, gather_emission: SIMD against their twins") {
  const Plan plan = test::test_plan();
  test::check_kernel(plan, "occlude");
  test::check_kernel(plan, "gather_emission");
}

TEST_CASE("occlude: says what the closest hit on the segment says, in lists and in trees") {
  std::mt19937 rng(11);
  const std::vector<Triangle> triangles = test::random_triangles(rng, 60, 1, 0.3f);
  std::vector<Ball> balls;
  for (int i = 0; i < 20; ++i) balls.push_back({test::random_point(rng, 1), 0.1f});
  constexpr uint32_t kRays = 2000;
  std::vector<test::Ray> rays;
  for (uint32_t i = 0; i < kRays; ++i) {
    const glm::vec3 o = test::random_point(rng, 1.2f);
    rays.push_back({o, test::random_point(rng, 1.0f)});
  }
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    for (const Keep keep : {Keep::kFlat, Keep::kTrees}) {
      const Plan plan = test::trace_plan(triangles, balls, keep);
      const std::vector<Path<float>> hits = test::trace(plan, rays);
      const PathBuffer buffer = test::paths_along(rays);
      const PathState& s = buffer.state();
      for (uint32_t i = 0; i < kRays; ++i) {
        s.l_x[i] = rays[i].d.x;
        s.l_y[i] = rays[i].d.y;
        s.l_z[i] = rays[i].d.z;
        s.c_r[i] = 1;
      }
      occlude(plan, s, {0, kRays});
      uint32_t wrong = 0, blocked = 0;
      for (uint32_t i = 0; i < kRays; ++i) {
        wrong += (s.L_r[i] == 0) != (hits[i].t < 1);
        blocked += s.L_r[i] == 0;
      }
      CHECK(wrong == 0);
      CHECK(blocked > kRays / 10);
      CHECK(blocked < kRays * 9 / 10);
    }
  });
}

TEST_CASE("occlude: what lies at either end of the segment does not block it") {
  const auto wall = [](float z) { return Triangle{glm::vec3(-1, -1, z), glm::vec3(1, -1, z), glm::vec3(0, 1, z)}; };
  const std::vector<Triangle> ends = {wall(0), wall(4)};
  std::vector<Triangle> blocked = ends;
  blocked.push_back(wall(3.9999995f));
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    for (const Keep keep : {Keep::kFlat, Keep::kTrees}) {
      const PathBuffer buffer = test::paths_along(std::vector<test::Ray>(3, {{0, 0, 0}, {0, 0, 1}}));
      const PathState& s = buffer.state();
      for (uint32_t i = 0; i < 3; ++i) {
        s.l_z[i] = 4;
        s.c_g[i] = i == 1 ? 0.0f : 2.0f;
      }
      occlude(test::trace_plan(ends, {}, keep), s, {0, 3});
      CHECK(s.L_g[0] == 2);
      CHECK(s.L_g[1] == 0);
      occlude(test::trace_plan(blocked, {}, keep), s, {0, 3});
      CHECK(s.L_g[2] == 2);
    }
  });
}

}  // namespace lanewise
