// Small and thin triangles: an absolute epsilon on Moeller-Trumbore's determinant, which is twice the triangle's area
// as the ray sees it, drops them (tinybvh pull request 283).
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/kernel_harness.h"
#include "tests/stability/clear_hit.h"
#include "tests/stability/curve.h"
#include "tests/stability/moeller_trumbore.h"
#include "tests/trace_plan.h"

namespace lanewise {
namespace {

using test::Ray;
using test::Triangle;

constexpr float kEpsilon = 1e-7f;  // the one of the textbooks
#ifdef NDEBUG
constexpr uint32_t kRays = 20'000;
#else
constexpr uint32_t kRays = 1'000;
#endif

// The shares of these sure hits of one triangle that the naive form and ours lose.
test::CurvePoint losses(double x, const Triangle& triangle, const std::vector<Ray>& rays) {
  uint32_t naive = 0, ours = 0;
  for (const Ray& ray : rays) naive += !test::moeller_trumbore(triangle, ray, kEpsilon);
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    for (const test::Keep keep : {test::Keep::kFlat, test::Keep::kTrees}) {
      uint32_t lost = 0;
      for (const Path<float>& p : test::trace(test::trace_plan({triangle}, {}, keep), rays)) lost += p.prim != 0;
      CHECK(lost == 0);
      ours = std::max(ours, lost);
    }
  });
  const double n = static_cast<double>(rays.size());
  return {x, naive / n, ours / n};
}

TEST_SUITE("stability") {
  TEST_CASE("small triangles: none is lost for its size") {
    test::Curve curve{.name = "small-triangles",
                      .title = "An absolute epsilon on the determinant drops small triangles",
                      .naive = "Moeller-Trumbore, |det| > 1e-7",
                      .ours = "kernels/triangle-inl.h, signs alone",
                      .x_axis = "edge of the triangle (size of the scene)",
                      .y_axis = "share of hits lost",
                      .points = {}};
    std::mt19937 rng(12);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int exponent = -1; exponent >= -8; --exponent) {
      const float size = std::pow(10.0f, static_cast<float>(exponent));
      CAPTURE(size);
      const Triangle triangle{size * glm::vec3(0.5f, -0.3f, 0.1f), size * glm::vec3(-0.4f, -0.4f, -0.2f),
                              size * glm::vec3(0.1f, 0.6f, 0.2f)};
      std::vector<Ray> rays;
      while (rays.size() < kRays) {
        // From some triangles away, as the next bounce of a fine mesh starts, and from the whole scene away where a
        // direction in floats can still be aimed at the triangle at all.
        const float away = size >= 1e-5f && rays.size() % 2 == 0 ? 1 : 10 * size;
        const float a = unit(rng), b = (1 - a) * unit(rng);
        const glm::vec3 o = away * test::random_direction(rng);
        const glm::vec3 target = (1 - a - b) * triangle[0] + a * triangle[1] + b * triangle[2];
        const Ray ray{o, glm::normalize(target - o)};
        if (test::clear_hit(triangle, ray, 0.05)) rays.push_back(ray);
      }
      curve.points.push_back(losses(size, triangle, rays));
    }
    CHECK(curve.points.front().naive == 0);
    CHECK(curve.points.back().naive == 1);
    CHECK(curve.worst_ours() == 0);
    test::record(curve);
  }

  TEST_CASE("small triangles: nor for its width") {
    test::Curve curve{.name = "thin-triangles",
                      .title = "An absolute epsilon on the determinant drops thin triangles",
                      .naive = "Moeller-Trumbore, |det| > 1e-7",
                      .ours = "kernels/triangle-inl.h, signs alone",
                      .x_axis = "height of the triangle (its base, the size of the scene)",
                      .y_axis = "share of hits lost",
                      .points = {}};
    std::mt19937 rng(13);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int exponent = -1; exponent >= -8; --exponent) {
      const float width = std::pow(10.0f, static_cast<float>(exponent));
      CAPTURE(width);
      const Triangle triangle{glm::vec3(-0.5f, 0, 0), glm::vec3(0.5f, 0, 0), glm::vec3(0, width, 0)};
      std::vector<Ray> rays;
      while (rays.size() < kRays) {
        // In planes of equal y, so that floats can say where the ray passes the narrow side.
        const float angle = 0.2f + 2.7f * unit(rng);
        const Ray ray{{unit(rng) - 0.5f, width * unit(rng), 1}, {std::cos(angle), 0, -std::sin(angle)}};
        if (test::clear_hit(triangle, ray, 0.05)) rays.push_back(ray);
      }
      curve.points.push_back(losses(width, triangle, rays));
    }
    CHECK(curve.points.front().naive == 0);
    CHECK(curve.points.back().naive == 1);
    CHECK(curve.worst_ours() == 0);
    test::record(curve);
  }
}

}  // namespace
}  // namespace lanewise
