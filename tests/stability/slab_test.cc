// The slab test of boxes: a box missed is a hit missed. Far from the origin plane * rcp - origin * rcp cancels; in the
// plane of a slab 0 * inf is NaN (Ize, Robust BVH Ray Traversal, JCGT 2(2), 2013).
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/kernel_harness.h"
#include "tests/stability/clear_hit.h"
#include "tests/stability/curve.h"
#include "tests/trace_plan.h"

namespace lanewise {
namespace {

using test::Ray;
using test::Triangle;

constexpr float kInf = std::numeric_limits<float>::infinity();
#ifdef NDEBUG
constexpr uint32_t kRays = 100'000;
#else
constexpr uint32_t kRays = 5'000;
#endif

// The textbook's test of the triangle's box; distance(plane, origin, rcp) is that of a plane along one axis.
template <class Distance>
bool naive_enters(const Triangle& t, const Ray& ray, const Distance& distance) {
  float t_near = 0, t_far = kInf;
  for (int a = 0; a < 3; ++a) {
    const float lo = std::min({t[0][a], t[1][a], t[2][a]}), hi = std::max({t[0][a], t[1][a], t[2][a]});
    const float rcp = 1 / ray.d[a];
    const float t0 = distance(lo, ray.o[a], rcp), t1 = distance(hi, ray.o[a], rcp);
    t_near = std::max(t_near, std::min(t0, t1));
    t_far = std::min(t_far, std::max(t0, t1));
  }
  return t_near <= t_far;
}

double per_100000(uint64_t n, size_t of) { return 1e5 * static_cast<double>(n) / static_cast<double>(of); }

uint32_t missed(const std::vector<Path<float>>& paths) {
  uint32_t n = 0;
  for (const Path<float>& p : paths) n += p.prim == kNoPrim;
  return n;
}

TEST_SUITE("stability") {
  TEST_CASE("slab: rays find their triangles however far both are from the origin") {
    test::Curve curve{.name = "slab-far",
                      .title = "Slab test far from the origin: hits lost because the ray misses the box",
                      .naive = "plane * rcp - origin * rcp",
                      .ours = "the tree of kernels/traverse-inl.h, slabs widened by 2^-20 of the reach",
                      .x_axis = "distance from the origin (lengths of a triangle)",
                      .y_axis = "hits missed per 100,000",
                      .points = {}};
    for (const float distance : {1e0f, 1e1f, 1e2f, 1e3f, 1e4f, 1e5f}) {
      CAPTURE(distance);
      std::mt19937 rng(11);
      std::uniform_real_distribution<float> unit(0, 1);
      const glm::vec3 far = distance * glm::normalize(glm::vec3(0.6f, -0.5f, 0.7f));
      // Slivers along the axes, as of hair and wires, whose boxes are slender along two axes at once.
      std::vector<Triangle> triangles;
      for (size_t i = 0; i < 256; ++i) {
        const glm::vec3 at = far + test::random_point(rng, 16);
        glm::vec3 along(0);
        along[static_cast<int>(i % 3)] = 1;
        triangles.push_back({at, at + along, at + 0.5f * along + test::random_point(rng, 0.03f)});
      }
      const Plan tree = test::trace_plan(triangles, {}, test::Keep::kTrees);
      std::vector<Ray> rays;
      uint32_t naive = 0;
      while (rays.size() < kRays) {
        const Triangle& t = triangles[rng() % triangles.size()];
        const float a = unit(rng), b = (1 - a) * unit(rng);
        const glm::vec3 o = far + test::random_point(rng, 16), target = (1 - a - b) * t[0] + a * t[1] + b * t[2];
        const Ray ray{o, glm::normalize(target - o)};
        if (!test::clear_hit(t, ray, 0.005)) continue;
        rays.push_back(ray);
        naive += !naive_enters(t, ray, [](float plane, float origin, float rcp) { return plane * rcp - origin * rcp; });
      }
      uint32_t ours = 0;
      test::for_each_target([&](const char* target) {
        CAPTURE(target);
        const uint32_t n = missed(test::trace(tree, rays));
        CHECK(n == 0);
        ours = std::max(ours, n);
      });
      curve.points.push_back({distance, per_100000(naive, rays.size()), per_100000(ours, rays.size())});
    }
    CHECK(curve.points.front().naive < 10);
    CHECK(curve.worst_naive() > 1000);
    CHECK(curve.worst_ours() == 0);
    test::record(curve);
  }

  TEST_CASE("slab: rays along an axis within the planes of boxes") {
    // Unit squares, a unit apart, and rays that meet them in their edges: within planes of their boxes.
    std::vector<Triangle> triangles;
    std::vector<Ray> rays;
    uint32_t naive = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = [axis](float height, float a, float b) {
        glm::vec3 p;
        p[axis] = height, p[(axis + 1) % 3] = a, p[(axis + 2) % 3] = b;
        return p;
      };
      for (float a = -10; a < 10; a += 2) {
        for (float b = -10; b < 10; b += 2) {
          const Triangle square[2] = {{at(3, a, b), at(3, a + 1, b), at(3, a + 1, b + 1)},
                                      {at(3, a, b), at(3, a + 1, b + 1), at(3, a, b + 1)}};
          triangles.insert(triangles.end(), {square[0], square[1]});
          for (const float zero : {0.0f, -0.0f}) {
            for (const glm::vec2 p : {glm::vec2(0, 0.5f), {1, 0.5f}, {0.5f, 0}, {0.5f, 1}, {0, 0}, {1, 1}}) {
              const Ray ray{at(-11, a + p.x, b + p.y), at(1, zero, zero)};
              rays.push_back(ray);
              naive += std::ranges::none_of(square, [&](const Triangle& t) {
                return naive_enters(t, ray, [](float plane, float o, float rcp) { return (plane - o) * rcp; });
              });
            }
          }
        }
      }
    }
    const Plan tree = test::trace_plan(triangles, {}, test::Keep::kTrees);
    CHECK(naive > rays.size() / 10);
    test::for_each_target([&](const char* target) {
      CAPTURE(target);
      uint32_t wrong = 0;
      for (const Path<float>& p : test::trace(tree, rays)) wrong += p.prim == kNoPrim;
      CHECK(wrong == 0);
    });
    MESSAGE("rays in the planes of slabs, of " << rays.size() << ": the naive form loses " << naive << ", ours none");
  }
}

}  // namespace
}  // namespace lanewise
