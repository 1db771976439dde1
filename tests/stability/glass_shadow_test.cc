// Light comes through a glass sphere by two refractions, so in its shadow a path that scatters twice finds none: floor,
// glass, and no more. Rays that start too far off a surface find a way.
#include <doctest/doctest.h>

#include <cmath>

#include "core/render.h"
#include "core/scene.h"
#include "tests/kernel_harness.h"
#include "tests/stability/curve.h"
#include "tests/stability/fixed_epsilon.h"
#include "core/verify/test_scene.h"

namespace lanewise {
namespace {

using glm::dvec3;

#ifdef NDEBUG
constexpr int kScales = 17;
#else
constexpr int kScales = 3;
#endif

// A Cornell box, black but for its floor, with a glass sphere on it.
Scene room() {
  Scene scene = test::test_box();
  scene.materials[test::kRed].reflectance = scene.materials[test::kBlue].reflectance = dvec3(0);
  scene.meshes.pop_back();                                                    // the small light
  for (const size_t wall : {1, 2}) scene.meshes[wall].material = test::kRed;  // ceiling and back
  scene.spheres = {{"glass", {-0.4, -0.3, 0.3}, 0.3, test::kGlassMaterial}};
  return scene;
}

Scene scaled(Scene scene, double scale) {
  for (Mesh& mesh : scene.meshes) {
    for (dvec3& p : mesh.positions) p *= scale;
  }
  for (Sphere& sphere : scene.spheres) sphere.center *= scale, sphere.radius *= scale;
  for (int axis = 0; axis < 3; ++axis) scene.cameras[0].to_world[3][axis] *= scale;
  return scene;
}

bool passes(const Sphere& sphere, const dvec3& from, const dvec3& to) {
  const dvec3 d = glm::normalize(to - from), l = sphere.center - from;
  return glm::length(l - glm::dot(l, d) * d) > sphere.radius;
}

// Pixels of which every corner sees floor, and floor in the umbra: hidden from all corners of the lamp, hence, for the
// sphere is convex, from all of it.
std::vector<size_t> umbra(const Scene& scene, const Settings& settings) {
  const Sphere& sphere = scene.spheres[0];
  Sphere hiding = sphere;  // from the camera; corners that see past it do not tell of what is between them
  hiding.radius *= 1.05;
  const dvec3 eye(scene.cameras[0].to_world[3]);
  const double pixel = 2 * std::tan(scene.cameras[0].xfov / 2) / settings.width;
  const auto in_umbra = [&](double x, double y) {
    const dvec3 d((x - settings.width / 2.0) * pixel, 1, (settings.height / 2.0 - y) * pixel);
    if (d.z >= 0) return false;
    const dvec3 p = eye - d * (eye.z / d.z);
    if (std::abs(p.x) > 1 || std::abs(p.y) > 1 || !passes(hiding, eye, p)) return false;
    for (const dvec3& corner : scene.meshes.back().positions) {
      if (passes(sphere, p, corner)) return false;
    }
    return true;
  };
  std::vector<size_t> pixels;
  for (uint32_t y = 0; y < settings.height; ++y) {
    for (uint32_t x = 0; x < settings.width; ++x) {
      if (in_umbra(x, y) && in_umbra(x + 1, y) && in_umbra(x, y + 1) && in_umbra(x + 1, y + 1)) {
        pixels.push_back(size_t{y} * settings.width + x);
      }
    }
  }
  return pixels;
}

double mean_of(const Image& image, const std::vector<size_t>& pixels) {
  double sum = 0;
  for (const size_t i : pixels) sum += double(image.rgb[3 * i] + image.rgb[3 * i + 1] + image.rgb[3 * i + 2]) / 3;
  return sum / double(pixels.size());
}

}  // namespace

TEST_SUITE_BEGIN("stability");

TEST_CASE("stability: the shadow of a glass sphere is black at -m 2") {
  test::Curve curve{.name = "glass-shadow",
                    .title = "Light in the shadow of a glass sphere at -m 2, where none can be",
                    .naive = "rays start 1e-4 units off surfaces",
                    .ours = "rays start each surface's error bound off it",
                    .x_axis = "scale of a room of 2 units",
                    .y_axis = "radiance in the umbra / mean radiance"};
  Settings settings;
  settings.width = 120, settings.height = 90, settings.threads = 1, settings.max_depth = 2;
  const std::vector<size_t> pixels = umbra(room(), settings);
  CHECK(pixels.size() > 50);
  std::vector<size_t> all(size_t{settings.width} * settings.height);
  for (size_t i = 0; i < all.size(); ++i) all[i] = i;
  for (const double scale : test::log_spaced(1e-4, 1e4, kScales)) {
    CAPTURE(scale);
    const Plan plan = make_plan(scaled(room(), scale), settings);
    const Image naive = render(test::with_fixed_epsilon(plan)).image;
    test::CurvePoint point{scale, mean_of(naive, pixels) / mean_of(naive, all), 0};
    test::for_each_target([&](const std::string& target) {
      CAPTURE(target);
      const Image ours = render(plan).image;
      CHECK(mean_of(ours, pixels) == 0);
      test::take_worst(point.ours, mean_of(ours, pixels) / mean_of(ours, all));
    });
    curve.points.push_back(point);
  }
  settings.max_depth = 3;  // the caustic
  const Image caustic = render(make_plan(room(), settings)).image;
  CHECK(mean_of(caustic, pixels) > 0.1 * mean_of(caustic, all));
  CHECK(curve.worst_naive() > 0.1);
  test::record(curve);
}

TEST_SUITE_END();

}  // namespace lanewise
