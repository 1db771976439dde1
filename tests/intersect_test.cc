#include "kernels/reference/intersect.h"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <random>

#include "tests/kernel_harness.h"
#include "tests/trace_plan.h"

namespace lanewise {
namespace {

using test::Ball;
using test::Keep;
using test::Ray;
using test::trace;
using test::trace_plan;
using test::Triangle;

std::vector<Ray> random_rays(std::mt19937& rng, size_t n, float half_side) {
  std::vector<Ray> rays;
  for (size_t i = 0; i < n; ++i) {
    const glm::vec3 o = test::random_point(rng, half_side);
    rays.push_back({o, test::random_direction(rng)});
  }
  return rays;
}

bool same_bits(float a, float b) { return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b); }

uint32_t differing(const std::vector<Path<float>>& a, const std::vector<Path<float>>& b) {
  uint32_t n = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    n += a[i].prim != b[i].prim || !same_bits(a[i].t, b[i].t) || !same_bits(a[i].u, b[i].u) ||
         !same_bits(a[i].v, b[i].v);
  }
  return n;
}

uint32_t missed(const std::vector<Path<float>>& paths) {
  uint32_t n = 0;
  for (const Path<float>& p : paths) n += p.prim == kNoPrim;
  return n;
}

// Hits at whose edge, or grazing angle, the last bits decide.
bool borderline(const Plan& plan, const Path<float>& hit) {
  if (hit.prim == kNoPrim || hit.prim >= plan.triangles) return false;
  const glm::vec3 n = reference::vec3<float>(&plan.prim_shape[size_t{4} * hit.prim]);
  const bool on_quad = hit.u == 0 && hit.v == 0;  // quads have no barycentric weights
  return (!on_quad && std::min({hit.u, hit.v, 1 - hit.u - hit.v}) < 1e-5f) ||
         std::abs(glm::dot(n, LANEWISE_VEC3(hit, d))) < 1e-2f;
}

// Rays from within the mesh to points of its edges and to its vertices: as near to them as floats come.
std::vector<Ray> rays_to_edges(std::mt19937& rng, const std::vector<Triangle>& mesh, size_t n) {
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<Ray> rays;
  for (size_t i = 0; i < n; ++i) {
    const glm::vec3 o = i % 5 == 0 ? glm::vec3(0) : test::random_point(rng, 0.2f);
    const Triangle& t = mesh[rng() % mesh.size()];
    const size_t k = rng() % 3;
    const glm::vec3 target = i % 3 == 0 ? t[k] : glm::mix(t[k], t[(k + 1) % 3], unit(rng));
    rays.push_back({o, i % 2 == 0 ? glm::normalize(target - o) : target - o});
  }
  return rays;
}

std::vector<Triangle> cube() {
  std::vector<Triangle> mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      const auto corner = [&](float a, float b) {
        glm::vec3 v;
        v[axis] = side;
        v[(axis + 1) % 3] = a;
        v[(axis + 2) % 3] = b;
        return v;
      };
      mesh.push_back({corner(-1, -1), corner(1, -1), corner(1, 1)});
      mesh.push_back({corner(-1, -1), corner(1, 1), corner(-1, 1)});
    }
  }
  return mesh;
}

}  // namespace

TEST_CASE("intersect: SIMD against its twin") {
  const Plan plan = test::test_plan();
  test::check_kernel(plan, "intersect");
}

TEST_CASE(
    "intersect: a ray's bits are the same in a flat list and in a tree, and with every vector width that has FMA") {
  std::mt19937 rng(2);
  const std::vector<Triangle> triangles = test::random_triangles(rng, 200, 1, 0.3f);
  std::vector<Ball> balls;
  for (int i = 0; i < 40; ++i) balls.push_back({test::random_point(rng, 1), 0.1f});
  const Plan flat = trace_plan(triangles, balls, Keep::kFlat), trees = trace_plan(triangles, balls, Keep::kTrees);
  const std::vector<Ray> rays = random_rays(rng, 2000, 1.5f);
  std::vector<Path<float>> wide;
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    const std::vector<Path<float>> hits = trace(flat, rays);
    CHECK(missed(hits) > 100);
    CHECK(missed(hits) < 1900);
    CHECK(differing(hits, trace(trees, rays)) == 0);
    if (std::string(target).starts_with("avx")) {
      if (!wide.empty()) CHECK(differing(hits, wide) == 0);
      wide = hits;
    }
  });
}

TEST_CASE("intersect: a tree finds what the twin finds among all triangles") {
  std::mt19937 rng(3);
  for (const float size : {0.02f, 0.5f}) {
    const std::vector<Triangle> triangles = test::random_triangles(rng, 3000, 1, size);
    const Plan flat = trace_plan(triangles, {}, Keep::kFlat), tree = trace_plan(triangles, {}, Keep::kTrees);
    const std::vector<Ray> rays = random_rays(rng, 500, 1.2f);
    test::for_each_target([&](const char* target) {
      CAPTURE(target);
      const std::vector<Path<float>> hits = trace(tree, rays);
      uint32_t wrong = 0;
      for (size_t i = 0; i < rays.size(); ++i) {
        const reference::Hit<double> want = reference::closest_hit<double>(flat, rays[i].o, rays[i].d);
        if (hits[i].prim == want.prim) {
          wrong += want.prim != kNoPrim && std::abs(hits[i].t - want.t) > 1e-4 * want.t && !borderline(flat, hits[i]);
        } else {
          wrong += !borderline(flat, hits[i]);
        }
      }
      CHECK(wrong <= 1);
    });
  }
}

TEST_CASE("intersect: of equal distances the lowest primitive wins") {
  std::mt19937 rng(4);
  const Triangle t{glm::vec3(-1, -1, 1), glm::vec3(1, -1, 1), glm::vec3(0, 1, 1)};
  std::vector<Triangle> triangles = test::random_triangles(rng, 20, 0.5f, 0.1f);
  for (Triangle& other : triangles) {
    for (glm::vec3& v : other) v.z += 3;
  }
  for (int i = 0; i < 30; ++i) triangles.push_back(t);
  const std::vector<Ray> rays(40, Ray{{0, 0, 0}, {0, 0, 1}});
  const std::vector<Ball> balls(20, Ball{{0, 0, 4}, 1});
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    for (const Keep keep : {Keep::kFlat, Keep::kTrees}) {
      for (const Path<float>& p : trace(trace_plan(triangles, {}, keep), rays)) {
        CHECK(p.prim == 20);
        CHECK(p.t == 1);
      }
      for (const Path<float>& p : trace(trace_plan({}, balls, keep), rays)) {
        CHECK(p.prim == 0);
        CHECK(p.t == 3);
      }
    }
  });
}

TEST_CASE("intersect: no ray leaks through edges and vertices of a closed mesh") {
  std::mt19937 rng(5);
  const std::vector<Triangle> coarse = test::bumpy_ball(1), fine = test::bumpy_ball(4);
  const std::vector<Ray> to_coarse = rays_to_edges(rng, coarse, 20000), to_fine = rays_to_edges(rng, fine, 50000);
  const std::vector<Ray> to_cube = rays_to_edges(rng, cube(), 30000);
  const Plan coarse_flat = trace_plan(coarse, {}, Keep::kFlat), coarse_tree = trace_plan(coarse, {}, Keep::kTrees);
  const Plan fine_tree = trace_plan(fine, {}, Keep::kTrees);
  const Plan cube_flat = trace_plan(cube(), {}, Keep::kFlat), cube_tree = trace_plan(cube(), {}, Keep::kTrees);
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    CHECK(missed(trace(coarse_flat, to_coarse)) == 0);
    CHECK(missed(trace(coarse_tree, to_coarse)) == 0);
    CHECK(missed(trace(fine_tree, to_fine)) == 0);
    CHECK(missed(trace(cube_flat, to_cube)) == 0);
    CHECK(missed(trace(cube_tree, to_cube)) == 0);
  });
}

TEST_CASE("intersect: nor through one far from the origin, in the plan's coordinates") {
  std::mt19937 rng(6);
  const glm::vec3 far(1000, -2000, 500);
  std::vector<Triangle> mesh = test::bumpy_ball(3);
  for (Triangle& t : mesh) {
    for (glm::vec3& v : t) v += far;
  }
  std::vector<Ray> rays = rays_to_edges(rng, mesh, 20000);
  for (Ray& ray : rays) {
    const glm::vec3 target = ray.o + ray.d;
    ray.o = far + test::random_point(rng, 0.1f);
    ray.d = target - ray.o;
  }
  const Plan tree = trace_plan(mesh, {}, Keep::kTrees);
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    CHECK(missed(trace(tree, rays)) == 0);
  });
}

TEST_CASE("intersect: rays along the axes, in the planes of boxes and of triangles") {
  // A grid of squares parallel to the axes: every box is flat and many of its planes hold the ray's origin.
  std::vector<Triangle> triangles;
  const auto square = [&](glm::vec3 p, glm::vec3 a, glm::vec3 b) {
    triangles.push_back({p, p + a, p + a + b});
    triangles.push_back({p, p + a + b, p + b});
  };
  for (int x = -4; x < 4; ++x) {
    for (int y = -4; y < 4; ++y) {
      square(glm::vec3(x, y, 4), {1, 0, 0}, {0, 1, 0});
      square(glm::vec3(x, y, -4), {1, 0, 0}, {0, 1, 0});
      square(glm::vec3(4, x, y), {0, 1, 0}, {0, 0, 1});
      square(glm::vec3(-4, x, y), {0, 1, 0}, {0, 0, 1});
      square(glm::vec3(x, 4, y), {1, 0, 0}, {0, 0, 1});
      square(glm::vec3(x, -4, y), {1, 0, 0}, {0, 0, 1});
    }
  }
  std::vector<Ray> rays;
  for (int x = -3; x <= 3; ++x) {
    for (int y = -3; y <= 3; ++y) {
      for (const float sign : {-1.0f, 1.0f}) {
        for (const float zero : {0.0f, -0.0f, 1e-30f, -1e-42f}) {
          rays.push_back({glm::vec3(x, y, 0), {zero, -zero, sign}});
          rays.push_back({glm::vec3(0, x, y), {sign, zero, zero}});
          rays.push_back({glm::vec3(y, 0, x), {zero, sign, zero}});
        }
      }
    }
  }
  const Plan tree = trace_plan(triangles, {}, Keep::kTrees);
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    uint32_t wrong = 0;
    for (const Path<float>& p : trace(tree, rays)) wrong += p.t != 4;
    CHECK(wrong == 0);
  });
}

TEST_CASE("intersect: spheres thousands of radii away") {
  std::mt19937 rng(7);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<Ray> rays;
  std::vector<double> want;
  const Ball ball{{0, 0, 0}, 1};
  for (int i = 0; i < 1000; ++i) {
    const glm::vec3 o = 10000.0f * test::random_direction(rng);
    // Towards points off the centre by up to 0.9 radii: there the true discriminant is at least 0.19.
    const glm::vec3 target = 0.9f * unit(rng) * test::random_direction(rng);
    rays.push_back({o, glm::normalize(target - o)});
    const glm::dvec3 od(o), dd(rays.back().d);
    want.push_back(reference::sphere_root<double>(od, dd, 1));
  }
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    for (const Keep keep : {Keep::kFlat, Keep::kTrees}) {
      const std::vector<Path<float>> hits = trace(trace_plan({}, {ball}, keep), rays);
      double worst = 0;
      for (size_t i = 0; i < hits.size(); ++i) worst = std::max(worst, std::abs(hits[i].t - want[i]));
      CHECK(worst < 0.01);  // floats at 10,000 are 0.001 apart; the textbook quadratic is off by 1
    }
  });
}

TEST_CASE("intersect: rays that are not numbers end, and meet nothing in a tree") {
  const Plan tree = trace_plan(test::bumpy_ball(2), {}, Keep::kTrees);
  std::vector<Ray> rays;
  for (const float bad : {NAN, INFINITY}) {
    for (int a = 0; a < 3; ++a) {
      Ray ray{{0.1f, 0.2f, 0.1f}, {0.6f, 0, 0.8f}};
      ray.o[a] = bad;
      rays.push_back(ray);
      rays.push_back({{0.1f, 0.2f, 0.1f}, ray.o});
    }
  }
  rays.push_back({{0, 0, 0}, {0, 0, 0}});
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    CHECK(missed(trace(tree, rays)) == rays.size());
  });
}

TEST_CASE("intersect: dead paths and empty plans hit nothing") {
  std::mt19937 rng(8);
  const std::vector<Triangle> triangles = test::bumpy_ball(1);
  const PathBuffer buffer = test::paths_along(random_rays(rng, 100, 0.1f));
  const PathState& s = buffer.state();
  for (uint32_t i = 0; i < 100; i += 2) s.beta_r[i] = s.beta_g[i] = s.beta_b[i] = 0;
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    for (const Keep keep : {Keep::kFlat, Keep::kTrees}) {
      intersect(trace_plan(triangles, {{{0, 0, 0}, 0.3f}}, keep), s, {0, 100});
      for (uint32_t i = 0; i < 100; ++i) {
        CHECK((s.prim[i] == kNoPrim) == (i % 2 == 0));
        CHECK((s.bin[i] == kFinished) == (i % 2 == 0));
        CHECK(std::isinf(s.t[i]) == (i % 2 == 0));
        if (i % 2 == 0) CHECK((s.u[i] == 0 && s.v[i] == 0));
      }
    }
  });
}

}  // namespace lanewise
