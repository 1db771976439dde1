#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "core/scene.h"
#include "kernels/reference/sample_light.h"
#include "kernels/reference/surface.h"
#include "tests/kernel_harness.h"
#include "core/verify/test_scene.h"
#include "tests/trace_plan.h"

namespace lanewise {
namespace {

using test::Ray;

// A closed box of quads, turned so that no face is parallel to an axis, seen from a camera at `distance` or inside.
Plan closed_box(double distance) {
  Scene scene = test::test_box();
  scene.spheres.clear();
  scene.meshes.resize(6);  // without the small light
  Mesh front = scene.meshes[2];
  for (glm::dvec3& p : front.positions) p.y = -1;
  scene.meshes.push_back(front);
  const glm::dvec3 x = glm::normalize(glm::dvec3(1, 0.3, -0.2)),
                   z = glm::normalize(glm::cross(x, glm::dvec3(0.1, 1, 0.4)));
  const glm::dmat3 turn(x, glm::cross(z, x), z);
  for (Mesh& mesh : scene.meshes) {
    for (glm::dvec3& p : mesh.positions) p = turn * p;
  }
  scene.cameras[0].to_world[3] = {0, -distance, 0.1, 1};
  return make_plan(scene, {});
}

}  // namespace

TEST_CASE("quad: no ray leaves a closed box through its edges and corners") {
  for (const double distance : {0.0, 30.0}) {
    const Plan plan = closed_box(distance);
    REQUIRE(plan.flat_quads.size() == 7);
    REQUIRE(plan.flat_triangles.empty());
    CHECK(plan.flat_slabs.size() == (distance == 0 ? 3 : 0));  // turned walls, translates but for rounding
    std::mt19937 rng(4);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto corner = [](const FlatQuad& q, double a, double b) {  // a, b in [-1, 1]
      const glm::dmat3 rows = glm::transpose(
          glm::dmat3(reference::vec3<double>(q.n), reference::vec3<double>(q.a), reference::vec3<double>(q.b)));
      return glm::inverse(rows) * glm::dvec3(q.distance, a - q.a_0, b - q.b_0);
    };
    std::vector<Ray> rays;
    for (int i = 0; i < 100000; ++i) {
      const FlatQuad& quad = plan.flat_quads[rng() % 7];
      const double side = rng() % 2 ? 1 : -1;
      const glm::dvec3 to = i % 4 == 0 ? corner(quad, side, rng() % 2 ? 1 : -1) : corner(quad, side, 2 * unit(rng) - 1);
      // From deep inside, and from near a face, where the ray grazes it.
      glm::dvec3 from = 0.6 * glm::dvec3(unit(rng) - 0.5, unit(rng) - 0.5, unit(rng) - 0.5);
      if (i % 3 == 0)
        from = corner(quad, 1.8 * (unit(rng) - 0.5), 1.8 * (unit(rng) - 0.5)) + 1e-4 * unit(rng) * (from - to);
      rays.push_back({glm::vec3(from), glm::normalize(glm::vec3(to) - glm::vec3(from))});
    }
    test::for_each_target([&](const char* target) {
      CAPTURE(target);
      uint32_t leaks = 0;
      for (const Path<float>& p : test::trace(plan, rays)) leaks += p.prim == kNoPrim;
      CHECK(leaks == 0);
    });
  }
}

TEST_CASE("quad: hits are those of its two triangles, but for a margin of millionths") {
  Plan quads = closed_box(3);
  quads.flat_slabs.clear();  // rays start outside, too
  quads.single_quads = static_cast<uint32_t>(quads.flat_quads.size());
  Plan triangles = quads;
  triangles.flat_quads.clear();
  triangles.flat_slabs.clear();
  triangles.single_quads = 0;
  std::mt19937 rng(5);
  for (const FlatQuad& q : quads.flat_quads) {
    CHECK(q.a_margin < 5e-5f);
    CHECK(q.b_margin < 5e-5f);
    const glm::dmat3 rows = glm::transpose(
        glm::dmat3(reference::vec3<double>(q.n), reference::vec3<double>(q.a), reference::vec3<double>(q.b)));
    const auto corner = [&](double a, double b) {
      return glm::vec3(glm::inverse(rows) * glm::dvec3(q.distance, a - q.a_0, b - q.b_0));
    };
    const glm::vec3 v[4] = {corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)};
    for (const auto& k : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
      FlatTriangle t{};
      for (int i = 0; i < 3; ++i) {
        for (int axis = 0; axis < 3; ++axis) t.v[i][axis] = v[k[static_cast<size_t>(i)]][axis];
      }
      t.prim = q.prim;
      triangles.flat_triangles.push_back(t);
    }
  }
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i) rays.push_back({test::random_point(rng, 2), test::random_direction(rng)});
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    const std::vector<Path<float>> a = test::trace(quads, rays), b = test::trace(triangles, rays);
    uint32_t different = 0, hits = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      hits += a[i].prim != kNoPrim;
      different += a[i].prim != b[i].prim || (a[i].prim != kNoPrim && std::abs(a[i].t - b[i].t) > 1e-3f * b[i].t);
    }
    CHECK(hits > 4000);
    CHECK(different <= 2);
  });
}

TEST_CASE("plan: a face on the scene's hull blocks no light between two points of the scene") {
  const Plan plan = make_plan(test::test_box(), {});
  // Floor, ceiling, three walls do not; the ceiling light, below the ceiling, does, and so does the small one.
  CHECK(plan.flat_quads.size() == 6);
  CHECK(plan.blocking_quads == 1);
  CHECK(plan.prim_bin[plan.flat_quads[0].prim] == kEmitter);
  CHECK(plan.blocking_triangles == 1);

  // A sphere that sticks out through the back wall makes that wall count.
  Scene scene = test::test_box();
  scene.spheres[0].center.y = 0.8;
  CHECK(make_plan(scene, {}).blocking_quads == 2);

  // Whatever segment one draws between surfaces of the scene: the same verdict as with all faces counted.
  Plan all = plan;
  all.blocking_quads = static_cast<uint32_t>(all.flat_quads.size());
  all.blocking_triangles = static_cast<uint32_t>(all.flat_triangles.size());
  std::mt19937 rng(6);
  PathBuffer a(4096), b(4096);
  std::vector<Ray> rays;
  for (int i = 0; i < 4096; ++i) rays.push_back({test::random_point(rng, 0.7f), test::random_direction(rng)});
  const std::vector<Path<float>> hits = test::trace(plan, rays);
  uint32_t lit = 0;
  for (uint32_t i = 0; i < 4096; ++i) {
    Path<float> p = hits[i];
    if (p.prim == kNoPrim) p = hits[0];
    reference::surface(plan, p);
    p.slot = i;
    p.step.light = i % 2;
    p.sample = i;
    reference::sample_light(plan, p);
    p.c_r = p.c_g = p.c_b =
        p.l_pdf > 0 &&
                (p.l_x * p.n_x + p.l_y * p.n_y + p.l_z * p.n_z) * (p.d_x * p.n_x + p.d_y * p.n_y + p.d_z * p.n_z) < 0
            ? 1.0f
            : 0.0f;
    p.L_r = p.L_g = p.L_b = 0;
    store_path(a.state(), i, p);
    store_path(b.state(), i, p);
  }
  occlude(plan, a.state(), {0, 4096});
  occlude(all, b.state(), {0, 4096});
  uint32_t different = 0;
  for (uint32_t i = 0; i < 4096; ++i) {
    lit += a.state().L_r[i] > 0;
    different += a.state().L_r[i] != b.state().L_r[i];
  }
  CHECK(lit > 500);
  CHECK(different == 0);
}

TEST_CASE("slab: two faces hit as one, to the bit") {
  const Plan slabs = make_plan(test::test_box(), {});
  REQUIRE(slabs.flat_slabs.size() == 2);  // left and right, floor and ceiling
  REQUIRE(slabs.single_quads == 2);       // the back wall, the light
  REQUIRE(slabs.flat_quads.size() == 6);
  Plan quads = slabs;
  quads.flat_slabs.clear();
  quads.single_quads = 6;
  const glm::vec3 half(1, 1, 0.75f);
  std::mt19937 rng(8);
  // Mostly between the walls, else exactly on them, with coordinates of directions that are 0, and aimed at edges and corners.
  const auto point = [&](uint32_t exact) {
    glm::vec3 p = test::random_point(rng, 1) * half;
    for (int axis = 0; axis < 3; ++axis) {
      if (rng() % 4 < exact) p[axis] = rng() % 2 ? half[axis] : -half[axis];
    }
    return p;
  };
  std::vector<Ray> rays;
  for (int i = 0; i < 40000; ++i) {
    Ray ray{point(i % 4 == 0), test::random_direction(rng)};
    if (i % 3 == 0) ray.d = point(2) - ray.o;
    if (i % 5 == 0) ray.d[static_cast<int>(rng() % 3)] = rng() % 2 ? 0.0f : -0.0f;
    if (ray.d == glm::vec3(0)) ray.d.z = 1;
    ray.d = glm::normalize(ray.d);
    rays.push_back(ray);
  }
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    const std::vector<Path<float>> a = test::trace(slabs, rays), b = test::trace(quads, rays);
    uint32_t different = 0, walls = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      different += a[i].prim != b[i].prim || a[i].t != b[i].t || a[i].bin != b[i].bin;
      for (const FlatSlab& slab : slabs.flat_slabs) walls += a[i].prim == slab.prim[0] || a[i].prim == slab.prim[1];
    }
    CHECK(different == 0);
    CHECK(walls > 10000);
  });
}

TEST_CASE("slab: only where every ray starts between its faces") {
  const auto slabs = [](const Scene& scene, const Settings& settings = {}) {
    const Plan plan = make_plan(scene, settings);
    CHECK(plan.single_quads + 2 * plan.flat_slabs.size() == plan.flat_quads.size());
    return plan.flat_slabs.size();
  };
  Scene scene = test::test_box();
  CHECK(slabs(scene) == 2);
  Settings lens;
  lens.lens_radius = 0.8;  // beyond floor and ceiling, but not beyond left and right
  CHECK(slabs(scene, lens) == 1);
  for (const double z : {-0.1, 0.0, 1.5, 2.0}) {
    scene.cameras[0].to_world[3] = {0, -3.5, z, 1};
    CHECK(slabs(scene) == 1);
  }
  scene.cameras[0].to_world[3] = {3, -3.5, 2, 1};
  CHECK(slabs(scene) == 0);

  scene = test::test_box();
  scene.spheres[0].center.x = 0.8;  // sticks out through the right wall
  CHECK(slabs(scene) == 1);
  scene = test::test_box();
  for (glm::dvec3& p : scene.meshes[4].positions) p.y *= 0.99;  // the right wall is no translate of the left one
  CHECK(slabs(scene) == 1);
}

}  // namespace lanewise
