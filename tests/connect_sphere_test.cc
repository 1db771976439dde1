#include "kernels/reference/connect_sphere.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <random>
#include <utility>

#include "core/scene.h"
#include "core/verify/test_scene.h"
#include "kernels/reference/shade_glass.h"
#include "kernels/reference/shade_mirror.h"
#include "tests/kernel_harness.h"

namespace lanewise {
namespace {

using glm::dvec3;
using reference::SphereReflection;

constexpr double kPi = std::numbers::pi;

Plan two_sample_plan(Scene scene) {
  Settings settings;
  settings.light_samples = 2;
  return make_plan(scene, settings);
}

// Where y is seen from x, both in the plane z = 0 and outside the unit sphere: the angle between x and the normal, by
// bisection of the difference between incidence and reflection; below 0 where nothing is reflected.
double angle_of_reflection(double a, double b, double gamma) {
  if (gamma > kPi - std::asin(1 / a) - std::asin(1 / b)) return -1;
  const auto incidence = [](double r, double theta) {
    return std::atan2(r * std::sin(theta), r * std::cos(theta) - 1);
  };
  double lo = 0, hi = gamma;
  for (int i = 0; i < 80; ++i) {
    const double middle = (lo + hi) / 2;
    (incidence(a, middle) > incidence(b, gamma - middle) ? hi : lo) = middle;
  }
  return (lo + hi) / 2;
}

// Two points outside the unit sphere, from touching it to far, at an angle up to and past where nothing is reflected.
struct Ends {
  double a, b, gamma;
};
Ends random_ends(std::mt19937& rng, double nearest) {
  std::uniform_real_distribution<double> unit(0, 1);
  const auto distance = [&] { return 1 + std::pow(10, std::log10(nearest) * unit(rng) + 2 * unit(rng)); };
  Ends e{distance(), distance(), 0};
  const double most = kPi - std::asin(1 / e.a) - std::asin(1 / e.b);
  const double kind = unit(rng), little = std::pow(10, -6 * unit(rng));
  e.gamma = kind < 0.3   ? most * (1 - little)
            : kind < 0.4 ? std::min(kPi, most * (1 + little))
            : kind < 0.6 ? most * little
                         : most * unit(rng);
  return e;
}

double area_across(const dvec3& at, const dvec3& along_u, const dvec3& along_v, const dvec3& ray) {
  return std::abs(glm::dot(glm::cross(along_u - at, along_v - at), ray));
}

// Where a ray from x in direction d, reflected at the unit sphere, meets the plane through y across `normal`.
dvec3 trace_by_mirror(const dvec3& x, const dvec3& d, const dvec3& y, const dvec3& normal) {
  const double b = glm::dot(x, d);
  const dvec3 n = x + (-b - std::sqrt(b * b - glm::dot(x, x) + 1)) * d;
  const dvec3 r = d - 2 * glm::dot(d, n) * n;
  return n + glm::dot(y - n, normal) / glm::dot(r, normal) * r;
}

}  // namespace

TEST_CASE("reflection: the twin finds the point that bisection finds, wherever there is one and only there") {
  std::mt19937 rng(5);
  uint32_t reflected = 0;
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const Ends e = random_ends(rng, 1e-6);
    const double angle = angle_of_reflection(e.a, e.b, e.gamma);
    const dvec3 x(e.a, 0, 0), y = e.b * dvec3(std::cos(e.gamma), std::sin(e.gamma), 0);
    const SphereReflection<double> r = reference::reflect_in_sphere(x, y, 1.0);
    const double most = kPi - std::asin(1 / e.a) - std::asin(1 / e.b);
    if (std::abs(e.gamma / most - 1) < 1e-9) continue;  // on the edge
    CHECK_UNARY(r.exists == (angle >= 0));
    if (angle < 0) continue;
    ++reflected;
    worst = std::max(worst, std::abs(std::atan2(r.n.y, r.n.x) - angle) / std::max(e.gamma, 1e-9));
  }
  CHECK(reflected > 15000);
  CHECK(worst < 1e-7);
}

TEST_CASE("reflection: the spread is what a bundle of rays spreads to") {
  std::mt19937 rng(6);
  double worst = 0;
  for (int i = 0; i < 2000; ++i) {
    const Ends e = random_ends(rng, 0.01);
    const dvec3 x(e.a, 0, 0), y = e.b * dvec3(std::cos(e.gamma), std::sin(e.gamma), 0);
    const SphereReflection<double> r = reference::reflect_in_sphere(x, y, 1.0);
    if (!r.exists || r.cosine < 0.02) continue;
    const dvec3 d = glm::normalize(r.n - x), out = r.to_y / r.distance, z(0, 0, 1);
    const double step = 1e-6 * std::min(glm::length(r.n - x), 1.0) / glm::length(r.n - x) * r.cosine;
    const dvec3 u = glm::normalize(d + step * glm::cross(z, d)), v = glm::normalize(d + step * z);
    const double area =
        area_across(trace_by_mirror(x, d, y, out), trace_by_mirror(x, u, y, out), trace_by_mirror(x, v, y, out), out);
    worst = std::max(worst, std::abs(area / (step * step) / r.spread - 1));
  }
  CHECK(worst < 1e-3);
}

TEST_CASE("connect_sphere: SIMD against its twin, by lights of all kinds and one to four spheres") {
  Scene scene = test::test_box();
  for (const uint32_t light : {0u, 1u}) {
    test::check_kernel(two_sample_plan(scene), "connect_sphere", {.bounce = 1, .light = light, .light_sample = 1});
  }
  scene.spheres[2].material = test::kSmallLight;
  test::check_kernel(two_sample_plan(scene), "connect_sphere", {.bounce = 1, .light = 2});
  scene.spheres[1].material = test::kRed;
  CHECK(two_sample_plan(scene).connected_spheres.size() == 1);
  test::check_kernel(two_sample_plan(scene), "connect_sphere");
  for (const double x : {-0.7, 0.0, 0.7}) scene.spheres.push_back({"more", {x, 0.6, 1.1}, 0.1, test::kGlassMaterial});
  CHECK(two_sample_plan(scene).connected_spheres.size() == 4);
  test::check_kernel(two_sample_plan(scene), "connect_sphere");
}

TEST_CASE("connect_sphere: light_<material> leaves to BSDF sampling what it samples densely") {
  Settings settings;
  settings.direct = Direct::kLight;
  Plan plan = make_plan(test::test_box(), settings);
  for (PlanMaterial& m : plan.materials) m.alpha = std::min(m.alpha, 0.01f);
  for (const char* kernel : {"light_diffuse", "light_microfacet"}) {
    test::check_kernel(plan, kernel, {.connection = true});
  }
}

TEST_CASE("occlude_connection: SIMD against its twin") {
  test::check_kernel(make_plan(test::test_box(), {}), "occlude_connection");
  test::check_kernel(test::test_plan(), "occlude_connection");
}

TEST_CASE("connect_sphere: which spheres the plan connects") {
  Scene scene = test::test_box();
  const auto connected = [&] { return make_plan(scene, {}).connected_spheres.size(); };
  CHECK(connected() == 2);
  Scene doubled = scene;
  doubled.spheres.push_back(scene.spheres[0]);
  CHECK(make_plan(doubled, {}).connected_spheres.empty());
  for (int i = 0; i < 3; ++i) scene.spheres.push_back({"ball", {0.2 * i, 0, 1}, 0.05, test::kMirrorMaterial});
  CHECK(connected() == 0);
  scene.spheres.pop_back();
  CHECK(connected() == 4);
  for (int i = 0; i < 3; ++i) scene.spheres.push_back({"lamp", {0.2 * i, 0, 0.8}, 0.05, test::kSmallLight});
  CHECK(connected() == 0);
}

TEST_CASE("connect_sphere: only with light samples, and where two more scattering events may follow") {
  Settings settings;
  const auto at = [&](uint32_t bounce) { return connects_at(make_plan(test::test_box(), settings), bounce); };
  CHECK(at(3));
  CHECK(!at(4));
  settings.connect = false;
  CHECK(!at(0));
  settings.connect = true;
  for (const Direct direct : {Direct::kBsdf, Direct::kHemisphere}) {
    settings.direct = direct;
    CHECK(!at(0));
  }
}

TEST_CASE("connect_sphere: what it covers is kConnected behind the sphere, and emission leaves it out") {
  Plan plan = make_plan(test::test_box(), {});
  const auto pdf_behind = [&](uint32_t bin, float pdf, bool outside) {
    const auto prim = static_cast<uint32_t>(std::ranges::find(plan.prim_bin, bin) - plan.prim_bin.begin());
    Path<double> p;
    p.prim = prim;
    p.pdf = double{pdf};
    p.n_z = p.s_z = 1;
    p.d_x = 0.8, p.d_z = outside ? -0.6 : 0.6;
    std::vector<double> seen;
    for (p.sample = 0; p.sample < 200; ++p.sample) {
      Path<double> q = p;
      bin == kMirror ? reference::shade_mirror(plan, q) : reference::shade_glass(plan, q);
      CHECK_UNARY(q.pdf == 0 || (q.pdf == double{kConnected} && (q.d_z > 0) == outside));
      seen.push_back(q.pdf);
    }
    return *std::ranges::min_element(seen);
  };
  for (const uint32_t bin : {uint32_t{kMirror}, uint32_t{kGlass}}) {
    CHECK(pdf_behind(bin, 0.3f, true) == double{kConnected});
    CHECK(pdf_behind(bin, 0.3f, false) == 0);
    CHECK(pdf_behind(bin, 2 * kMostConnectedPdf, true) == 0);
    CHECK(pdf_behind(bin, 0, true) == 0);
    CHECK(pdf_behind(bin, kConnected, true) == 0);
    const std::vector<ConnectedSphere> spheres = std::exchange(plan.connected_spheres, {});
    CHECK(pdf_behind(bin, 0.3f, true) == 0);
    plan.connected_spheres = spheres;
  }
}

}  // namespace lanewise
