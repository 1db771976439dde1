// A sphere that touches the floor: towards the point of contact the gap between them becomes thinner than any distance by
// which rays are kept off surfaces. A ray from the floor then starts inside the sphere: glass sheds light into its own
// shadow, and a lamp lights nothing. With error bounds that happens below 6e-6 units in a room of 2, within 0.005 radii
// of the contact: as near as floats can tell the two apart, within a factor of 10.
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

constexpr double kRadius = 0.3, kAlbedo = 0.6, kRadiance = 10;

// Distance from the point of contact, in radii, at which the gap is this wide.
double away_of(double gap) { return std::sqrt(gap / kRadius * (2 - gap / kRadius)); }

// Floor, ceiling lamp and a ball that touches the floor at the origin; the camera is where the gap is this wide, and
// looks straight down from its middle. All walls are black.
Scene room(double gap, uint32_t ball) {
  Scene scene = test::test_box();
  scene.meshes = {scene.meshes[0], scene.meshes[5]};  // floor and lamp
  scene.spheres = {{"ball", {0, 0, kRadius}, kRadius, ball}};
  scene.cameras[0].to_world = glm::dmat4(1.0);
  scene.cameras[0].to_world[3] = glm::dvec4(glm::dvec3(away_of(gap) * kRadius, 0, gap / 2), 1);
  return scene;
}

Settings small(uint32_t max_depth) {
  Settings settings;
  settings.width = 20, settings.height = 15, settings.spp = 64, settings.threads = 1;
  settings.max_depth = max_depth;
  settings.light_paths = false;  // which would not start where the sphere touches
  return settings;
}

double mean_radiance(const Plan& plan) {
  const Image image = render(plan).image;
  double sum = 0;
  for (const float x : image.rgb) sum += double(x);
  return sum / double(image.rgb.size());
}

const std::vector<double> kGaps = test::log_spaced(8e-6, 0.06, 14);

}  // namespace

TEST_SUITE_BEGIN("stability");

TEST_CASE("stability: a glass sphere that touches the floor is dark below at -m 2") {
  // Light comes through glass by two refractions, and the floor is one scattering more.
  test::Curve curve{.name = "touching-sphere-shadow",
                    .title = "Light in the shadow of a glass sphere that touches the floor, at -m 2 (none can be)",
                    .naive = "rays start 1e-4 units off surfaces",
                    .ours = "rays start each surface's error bound off it",
                    .x_axis = "gap between floor and sphere (units; a room of 2)",
                    .y_axis = "radiance / the lit floor's"};
  const double lit = kAlbedo * kRadiance * 0.48 / std::numbers::pi / (1.49 * 1.49);
  for (const double gap : kGaps) {
    const Plan plan = make_plan(room(gap, test::kGlassMaterial), small(2));
    test::CurvePoint point{gap, mean_radiance(test::with_fixed_epsilon(plan)) / lit, 0};
    test::for_each_target([&](const std::string& target) {
      CAPTURE(target);
      CAPTURE(gap);
      const double ours = mean_radiance(plan);
      CHECK(ours == 0);
      test::take_worst(point.ours, ours / lit);
    });
    curve.points.push_back(point);
  }
  CHECK(curve.points.front().naive > 0.1);
  CHECK(mean_radiance(make_plan(room(1e-3, test::kGlassMaterial), small(3))) > 0.1 * lit);  // the caustic
  test::record(curve);
}

TEST_CASE("stability: a lamp that touches the floor lights it up to the point of contact") {
  // All of the sphere is above the horizon: E = pi L (r / d)^2 cos, with cos = r / d.
  test::Curve curve{.name = "touching-sphere-lamp",
                    .title = "Light of a spherical lamp that touches the floor, 19,200 samples",
                    .naive = "rays start 1e-4 units off surfaces",
                    .ours = "rays start each surface's error bound off it",
                    .x_axis = "gap between floor and sphere (units; a room of 2)",
                    .y_axis = "relative error of radiance"};
  for (const double gap : kGaps) {
    const Plan plan = make_plan(room(gap, test::kCeilingLight), small(1));
    const double want = kAlbedo * kRadiance * std::pow(1 + away_of(gap) * away_of(gap), -1.5);
    test::CurvePoint point{gap, std::abs(mean_radiance(test::with_fixed_epsilon(plan)) / want - 1), 0};
    test::for_each_target([&](const std::string& target) {
      CAPTURE(target);
      CAPTURE(gap);
      const double ours = std::abs(mean_radiance(plan) / want - 1);
      CHECK(ours < 0.02);
      test::take_worst(point.ours, ours);
    });
    curve.points.push_back(point);
  }
  CHECK(curve.points.front().naive > 0.9);
  test::record(curve);
}

TEST_SUITE_END();

}  // namespace lanewise
