#include "kernels/reference/surface.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "tests/kernel_harness.h"
#include "tests/trace_plan.h"

namespace lanewise {
namespace {

using test::Ball;
using test::Keep;
using test::Triangle;

// A unit vector at the angle acos(cosine) from n.
glm::vec3 direction_at(std::mt19937& rng, const glm::vec3& n, float cosine) {
  const glm::vec3 side = glm::normalize(glm::cross(n, test::random_direction(rng)));
  return glm::normalize(cosine * n + std::sqrt(1 - cosine * cosine) * side);
}

// Cosines from the pole down to the last float before the tangent, on both sides.
float random_cosine(std::mt19937& rng) {
  std::uniform_real_distribution<float> unit(0, 1);
  const float sign = rng() % 2 == 0 ? 1.0f : -1.0f;
  return sign * (rng() % 2 == 0 ? unit(rng) : std::exp2(-30 * unit(rng)));
}

// Sends rays at a plan's only primitive and from where they hit on, to either side of it.
struct Bounce {
  uint32_t hits = 0;
  uint32_t left = 0, met_again = 0;  // on the normal's side
  uint32_t entered = 0, lost = 0;    // on the other
  Plan plan;

  void run(std::mt19937& rng, const std::vector<test::Ray>& rays) {
    const PathBuffer buffer = test::paths_along(rays);
    const PathState& s = buffer.state();
    const uint32_t n = static_cast<uint32_t>(rays.size());
    intersect(plan, s, {0, n});
    std::vector<uint32_t> first(n);
    std::vector<bool> out(n);
    for (uint32_t i = 0; i < n; ++i) first[i] = s.prim[i];
    for (uint32_t i = 0; i < round_up_to_lanes(n); ++i) {  // as the sort would leave it: no misses, harmless padding
      if (s.prim[i] == kNoPrim) s.prim[i] = 0;
      if (!(s.t[i] < 1e30f)) s.t[i] = 1;
    }
    surface(plan, s, {0, n});
    for (uint32_t i = 0; i < n; ++i) {
      const Path<float> p = load_path<float>(s, i);
      const glm::vec3 normal = LANEWISE_VEC3(p, n);
      const glm::vec3 d = direction_at(rng, normal, random_cosine(rng));
      out[i] = !std::signbit(glm::dot(d, normal));
      const glm::vec3 o = reference::offset_origin<float>(LANEWISE_VEC3(p, o), normal, p.err, d);
      s.o_x[i] = o.x;
      s.o_y[i] = o.y;
      s.o_z[i] = o.z;
      s.d_x[i] = d.x;
      s.d_y[i] = d.y;
      s.d_z[i] = d.z;
    }
    intersect(plan, s, {0, n});
    for (uint32_t i = 0; i < n; ++i) {
      if (first[i] == kNoPrim) continue;
      ++hits;
      const bool again = s.prim[i] == first[i];
      (out[i] ? left : entered) += 1;
      met_again += out[i] && again;
      lost += !out[i] && !again;
    }
  }
};

}  // namespace

TEST_CASE("surface: SIMD against its twin") {
  const Plan plan = test::test_plan();
  REQUIRE(!plan.prim_normals.empty());
  test::check_kernel(plan, "surface");
}

TEST_CASE("surface: corner normals that cancel leave the face's own") {
  Plan plan =
      test::trace_plan({Triangle{glm::vec3(-1, -1, 0), glm::vec3(1, -1, 0), glm::vec3(0, 1, 0)}}, {}, Keep::kFlat);
  plan.prim_normals.assign({1, 0, 0, -1, 0, 0, 0, 0, 0});
  const PathBuffer buffer = test::paths_along({{{0, 0, 1}, {0, 0, -1}}, {{0, 0, 1}, {0, 0, -1}}});
  const PathState& s = buffer.state();
  s.t[0] = s.t[1] = 1;
  s.u[0] = 0.5f;
  s.u[1] = 0.25f;
  s.v[0] = s.v[1] = 0;
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    s.o_z[0] = s.o_z[1] = 1;
    surface(plan, s, {0, 2});
    CHECK(s.s_z[0] == 1);
    CHECK(s.s_x[0] == 0);
    CHECK(s.s_x[1] == 1);
    CHECK(s.o_z[0] == 0);
  });
}

TEST_CASE("surface: rays leave spheres of all sizes, and those inside find the far wall") {
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    std::mt19937 rng(21);
    std::uniform_real_distribution<float> unit(0, 1);
    Bounce total;
    for (int i = 0; i < 300; ++i) {
      const float radius = std::pow(10.0f, -3 + 7 * unit(rng));
      // Up to 1e5 off the origin; where coordinates are so coarse that the sphere is thinner than err, only leaving it
      // has a meaning.
      const float away = std::min(1e5f, 1e4f * radius) * unit(rng);
      const glm::vec3 center = away * test::random_direction(rng);
      total.plan = test::trace_plan({}, {Ball{center, radius}}, i % 2 == 0 ? Keep::kFlat : Keep::kTrees);
      std::vector<test::Ray> rays;
      for (int k = 0; k < 100; ++k) {
        const glm::vec3 o = center + radius * 3.0f * test::random_direction(rng);
        const glm::vec3 to = center + 0.99f * radius * test::random_direction(rng);
        rays.push_back({o, glm::normalize(to - o)});
      }
      total.run(rng, rays);
    }
    CHECK(total.hits > 25000);
    CHECK(total.met_again == 0);
    CHECK(total.lost == 0);
  });
}

TEST_CASE("surface: rays leave triangles of all sizes and shapes") {
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    std::mt19937 rng(22);
    std::uniform_real_distribution<float> unit(0, 1);
    Bounce total;
    uint32_t below = 0;
    for (int i = 0; i < 300; ++i) {
      const float size = std::pow(10.0f, -3 + 7 * unit(rng));
      const glm::vec3 at = (i % 3 == 0 ? 0.0f : std::min(1e5f, 1e5f * size) * unit(rng)) * test::random_direction(rng);
      Triangle t = test::random_triangles(rng, 1, 0, size)[0];
      for (glm::vec3& v : t) v += at;
      total.plan = test::trace_plan({t}, {}, i % 2 == 0 ? Keep::kFlat : Keep::kTrees);
      std::vector<test::Ray> rays;
      for (int k = 0; k < 100; ++k) {
        const float u = unit(rng), v = unit(rng) * (1 - u);
        const glm::vec3 to = (1 - u - v) * t[0] + u * t[1] + v * t[2];
        const glm::vec3 o = to + 2 * size * test::random_direction(rng);
        rays.push_back({o, glm::normalize(to - o)});
      }
      total.run(rng, rays);
      below = total.entered - total.lost;  // met again from the other side
    }
    CHECK(total.hits > 10000);
    CHECK(total.met_again == 0);
    CHECK(below == 0);
  });
}

}  // namespace lanewise
