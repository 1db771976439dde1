// The textbook's quadratic for a sphere subtracts squares of the distance that leave nothing of the radius when the
// sphere is far away.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/kernel_harness.h"
#include "tests/stability/curve.h"
#include "tests/trace_plan.h"

namespace lanewise {
namespace {

using glm::dvec3;

constexpr uint32_t kRays = 500;

// Discriminant of the sphere of radius 1 around the origin, for a unit direction, as it is mostly written.
float naive_discriminant(const glm::vec3& o, const glm::vec3& d) {
  const float b = glm::dot(o, d), c = glm::dot(o, o) - 1;
  return b * b - c;
}

// -1: the ray misses.
float naive_distance(const test::Ray& ray) {
  const float discriminant = naive_discriminant(ray.o, ray.d);
  return discriminant < 0 ? -1 : -glm::dot(ray.o, ray.d) - std::sqrt(discriminant);
}

double exact_distance(const test::Ray& ray) {
  const dvec3 o(ray.o), d(ray.d);
  const double a = glm::dot(d, d), b = glm::dot(o, d) / a;
  const dvec3 foot = o - b * d;
  return -b - std::sqrt((1 - glm::dot(foot, foot)) / a);
}

// Rays at the unit sphere from a distance in radii, which pass the centre at half a radius.
std::vector<test::Ray> rays_from(double distance) {
  std::mt19937 rng(5);
  std::vector<test::Ray> rays;
  while (rays.size() < kRays) {
    const dvec3 away(test::random_direction(rng)), side = glm::cross(away, dvec3(test::random_direction(rng)));
    if (glm::length(side) < 0.1) continue;
    const glm::vec3 o(distance * away);
    rays.push_back({o, glm::vec3(glm::normalize(0.5 * glm::normalize(side) - dvec3(o)))});
  }
  return rays;
}

struct Errors {
  double depth = 0;   // mean error of the distance of hits, in radii
  double missed = 0;  // share of rays
};

template <class Distance>
Errors errors(const std::vector<test::Ray>& rays, const Distance& distance_of) {
  Errors e;
  uint32_t hits = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const double t = distance_of(i);
    if (!(t > 0 && std::isfinite(t))) continue;
    e.depth += std::abs(t - exact_distance(rays[i]));
    ++hits;
  }
  e.depth = hits > 0 ? e.depth / hits : std::numeric_limits<double>::infinity();
  e.missed = 1 - double(hits) / kRays;
  return e;
}

}  // namespace

TEST_SUITE_BEGIN("stability");

TEST_CASE("stability: spheres at 10,000 radii and beyond") {
  test::Curve depth{.name = "sphere-quadratic",
                    .title = "Rays at half a radius off the centre of a distant sphere: where they meet it",
                    .naive = "b² − c, float",
                    .ours = "r² − |foot of the perpendicular|²",
                    .x_axis = "distance (radii)",
                    .y_axis = "mean error of depth (radii)"};
  test::Curve missed = depth;
  missed.name = "sphere-quadratic-misses";
  missed.title = "Rays at half a radius off the centre of a distant sphere: whether they meet it";
  missed.y_axis = "share of rays that miss";
  for (const double distance : test::log_spaced(1, 1e6, 25)) {
    const double from = std::max(distance, 1.1);
    const std::vector<test::Ray> rays = rays_from(from);
    const Errors naive = errors(rays, [&](size_t i) { return double(naive_distance(rays[i])); });
    Errors ours;
    test::for_each_target([&](const char*) {
      for (const test::Keep keep : {test::Keep::kFlat, test::Keep::kTrees}) {
        const std::vector<Path<float>> hits = test::trace(test::trace_plan({}, {{{0, 0, 0}, 1}}, keep), rays);
        const Errors e = errors(rays, [&](size_t i) { return double(hits[i].t); });
        test::take_worst(ours.depth, e.depth);
        test::take_worst(ours.missed, e.missed);
      }
    });
    CAPTURE(from);
    // Half the spacing of floats at that distance: that of directions moves the ray itself, for both alike.
    CHECK(ours.depth < 0x1p-23 * from);
    CHECK(ours.missed == 0);
    depth.points.push_back({from, naive.depth, ours.depth});
    missed.points.push_back({from, naive.missed, ours.missed});
  }
  CHECK(naive_discriminant({0.5f, 0, -4096}, {0, 0, 1}) == 1);  // 0.75 is right
  CHECK(naive_discriminant({0.5f, 0, -10000}, {0, 0, 1}) == 0);
  CHECK(missed.worst_naive() > 0.4);
  CHECK(depth.worst_naive() > 0.5);
  test::record(depth);
  test::record(missed);
}

TEST_SUITE_END();

}  // namespace lanewise
