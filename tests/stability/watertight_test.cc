// Rays through shared edges and vertices leak where each triangle rounds its own edge functions (embree issues 174 and
// 181). Woop, Benthin & Wald, Watertight Ray/Triangle Intersection, JCGT 2(1), 2013.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "core/scene.h"
#include "tests/kernel_harness.h"
#include "tests/stability/curve.h"
#include "tests/stability/moeller_trumbore.h"
#include "core/verify/test_scene.h"
#include "tests/trace_plan.h"

namespace lanewise {
namespace {

using test::Keep;
using test::Ray;
using test::Triangle;

#ifdef NDEBUG
constexpr uint32_t kRays = 100'000;
#else
constexpr uint32_t kRays = 5'000;
#endif

double per_100000(uint32_t n, size_t of) { return 1e5 * n / static_cast<double>(of); }

uint32_t leaks(const Plan& plan, const std::vector<Ray>& rays) {
  uint32_t n = 0;
  for (const Path<float>& p : test::trace(plan, rays)) n += p.prim == kNoPrim;
  return n;
}

// The most leaks that any target has, in a flat list or in a tree.
uint32_t worst_leaks(const std::vector<Triangle>& mesh, const std::vector<Ray>& rays) {
  uint32_t worst = 0;
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    for (const Keep keep : {Keep::kFlat, Keep::kTrees}) {
      if (keep == Keep::kFlat && mesh.size() > 100) continue;
      const uint32_t n = leaks(test::trace_plan(mesh, {}, keep), rays);
      CHECK(n == 0);
      worst = std::max(worst, n);
    }
  });
  return worst;
}

uint32_t naive_leaks(const std::vector<Triangle>& mesh, std::span<const Ray> rays) {
  return static_cast<uint32_t>(std::ranges::count_if(rays, [&](const Ray& ray) {
    return std::ranges::none_of(mesh, [&](const Triangle& t) { return test::moeller_trumbore(t, ray, 0); });
  }));
}

// Towards a point of an edge, or to a vertex, as near as floats come; from around `eye`.
Ray ray_to_edge(std::mt19937& rng, const Triangle& t, const glm::vec3& eye, float around) {
  std::uniform_real_distribution<float> unit(0, 1);
  const size_t k = rng() % 3;
  const glm::vec3 target = rng() % 3 == 0 ? t[k] : glm::mix(t[k], t[(k + 1) % 3], unit(rng));
  const glm::vec3 o = eye + test::random_point(rng, around);
  return {o, rng() % 2 == 0 ? glm::normalize(target - o) : target - o};
}

TEST_SUITE("stability") {
  TEST_CASE("watertight: 100,000 rays at the edges and vertices of a closed mesh, moved away from the origin") {
    test::Curve curve{.name = "watertight",
                      .title = "Rays that leave a closed mesh through its edges and vertices",
                      .naive = "Moeller-Trumbore: each triangle rounds its own edges",
                      .ours = "kernels/triangle-inl.h",
                      .x_axis = "distance of the mesh from the origin (its radii)",
                      .y_axis = "leaks per 100,000 rays",
                      .points = {}};
    for (const float distance : {1e0f, 1e2f, 1e3f, 1e5f}) {
      CAPTURE(distance);
      std::mt19937 rng(14);
      const glm::vec3 eye = distance * glm::normalize(glm::vec3(2, -4, 1));
      std::vector<Triangle> mesh = test::bumpy_ball(1);
      for (Triangle& t : mesh) {
        for (glm::vec3& v : t) v += eye;
      }
      std::vector<Ray> rays;
      while (rays.size() < kRays) rays.push_back(ray_to_edge(rng, mesh[rng() % mesh.size()], eye, 0.2f));
      const std::span<const Ray> some = std::span(rays).first(kRays / 5);  // brute force takes its time
      curve.points.push_back({distance, per_100000(naive_leaks(mesh, some), some.size()),
                              per_100000(worst_leaks(mesh, rays), rays.size())});
    }
    CHECK(curve.worst_naive() > 50);
    CHECK(curve.worst_ours() == 0);
    test::record(curve);
  }

  TEST_CASE("watertight: and of a finer one, of any size") {
    for (const float scale : {1e-6f, 1.0f, 1e6f}) {
      CAPTURE(scale);
      std::mt19937 rng(15);
      std::vector<Triangle> mesh = test::bumpy_ball(4);
      for (Triangle& t : mesh) {
        for (glm::vec3& v : t) v *= scale;
      }
      std::vector<Ray> rays;
      while (rays.size() < kRays) {
        rays.push_back(ray_to_edge(rng, mesh[rng() % mesh.size()], glm::vec3(0), 0.2f * scale));
      }
      CHECK(worst_leaks(mesh, rays) == 0);
    }
  }

  TEST_CASE("watertight: pairs of triangles, the shared edge and its vertices seen from all sides") {
    // Around each vertex lies a fan, so that a ray at any vertex of the inner edges has something to meet.
    std::mt19937 rng(16);
    uint32_t naive = 0, ours = 0, rays_in_all = 0;
    constexpr int kFans = 20;
    for (int fan = 0; fan < kFans; ++fan) {
      constexpr size_t kCorners = 7;
      const glm::vec3 hub = test::random_point(rng, 0.2f);
      std::vector<glm::vec3> rim;
      for (size_t i = 0; i < kCorners; ++i) {
        const float angle = 2 * 3.14159265f * static_cast<float>(i) / kCorners;
        rim.push_back(glm::vec3(std::cos(angle), std::sin(angle), 0) + test::random_point(rng, 0.3f));
      }
      std::vector<Triangle> triangles;
      for (size_t i = 0; i < kCorners; ++i) triangles.push_back({hub, rim[i], rim[(i + 1) % kCorners]});
      std::vector<Ray> rays;
      std::uniform_real_distribution<float> unit(0, 1);
      while (rays.size() < kRays / kFans) {
        // Every fifth at the hub, half of those exactly, along an axis; the rest along the spokes.
        const bool at_hub = rng() % 5 == 0;
        const glm::vec3 target = at_hub ? hub : glm::mix(hub, rim[rng() % kCorners], 0.9f * unit(rng));
        glm::vec3 o = test::random_point(rng, 0.4f);
        if (at_hub && rng() % 2) o = hub;
        o.z += rng() % 2 ? 3.0f : -3.0f;
        rays.push_back({o, glm::normalize(target - o)});
      }
      naive += naive_leaks(triangles, rays);
      ours += worst_leaks(triangles, rays);
      rays_in_all += static_cast<uint32_t>(rays.size());
    }
    CHECK(rays_in_all == kRays);
    CHECK(naive > 0);
    CHECK(ours == 0);
    MESSAGE("leaks between triangles, of " << kRays << " rays: naive " << naive << ", ours " << ours);
  }

  TEST_CASE("watertight: the seams of parallelograms, with each other and with triangles") {
    // A closed box, turned: four parallelograms, a back wall of triangles enough to go into the tree, a fan in front.
    Scene scene = test::test_box();
    scene.spheres.clear();
    scene.meshes.resize(5);
    Mesh front = scene.meshes[2];
    for (glm::dvec3& p : front.positions) p.y = -1;
    scene.meshes.push_back(front);
    scene.meshes.back().positions.push_back({0.1, -1, 0.4});
    scene.meshes.back().triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    Mesh& back = scene.meshes[2];
    back.positions.clear();
    back.triangles.clear();
    for (uint32_t row = 0; row <= 4; ++row) {
      for (uint32_t column = 0; column <= 4; ++column) {
        back.positions.push_back({-1 + 0.5 * column, 1, 0.375 * row});
        if (row == 4 || column == 4) continue;
        const uint32_t a = 5 * row + column;
        back.triangles.push_back({a, a + 1, a + 6});
        back.triangles.push_back({a, a + 6, a + 5});
      }
    }
    const glm::dvec3 x = glm::normalize(glm::dvec3(1, 0.3, -0.2)),
                     z = glm::normalize(glm::cross(x, glm::dvec3(0.1, 1, 0.4)));
    const glm::dmat3 turn(x, glm::cross(z, x), z);
    for (Mesh& mesh : scene.meshes) {
      for (glm::dvec3& p : mesh.positions) p = turn * p;
    }
    const auto rotated = [&](double px, double py, double pz) { return turn * glm::dvec3(px, py, pz); };

    const Plan plan = make_plan(scene, {});
    REQUIRE(plan.flat_quads.size() == 4);
    REQUIRE(plan.flat_triangles.size() == 4);
    REQUIRE(plan.triangle_blocks.size() > 0);
    Plan naive = plan;
    for (FlatQuad& quad : naive.flat_quads) quad.a_margin = quad.b_margin = 0;
    for (FlatSlab& slab : naive.flat_slabs) slab.a_margin = slab.b_margin = 0;

    std::mt19937 rng(17);
    std::uniform_real_distribution<double> side(-1, 1), height(0, 1.5);
    const glm::dvec3 center(plan.center[0], plan.center[1], plan.center[2]);
    std::vector<Ray> rays;
    while (rays.size() < kRays) {
      // A point of one of the twelve edges, every fourth time a corner.
      glm::dvec3 p(rng() % 2 ? 1 : -1, rng() % 2 ? 1 : -1, rng() % 2 ? 1.5 : 0);
      if (rng() % 4 != 0) {
        const int axis = static_cast<int>(rng() % 3);
        p[axis] = axis == 2 ? height(rng) : side(rng);
      }
      const glm::vec3 o(rotated(0.7 * side(rng), 0.7 * side(rng), 0.1 + 0.8 * height(rng)) - center);
      rays.push_back({o, glm::normalize(glm::vec3(rotated(p.x, p.y, p.z) - center) - o)});
    }
    uint32_t naive_leaked = 0;
    test::for_each_target([&](const char* target) {
      CAPTURE(target);
      naive_leaked = std::max(naive_leaked, leaks(naive, rays));
      CHECK(leaks(plan, rays) == 0);
    });
    CHECK(naive_leaked > kRays / 200);
    MESSAGE("leaks at the seams of parallelograms, of " << kRays << " rays: without margins " << naive_leaked
                                                        << ", ours none");
  }
}

}  // namespace
}  // namespace lanewise
