// Towards alpha = 0 a metal must become the mirror: with all of its light, and without a step on the way.
#include <doctest/doctest.h>

#include "core/render.h"
#include "tests/kernel_harness.h"
#include "tests/stability/curve.h"
#include "tests/stability/microfacet_lobe.h"
#include "core/verify/test_scene.h"

namespace lanewise {
namespace {

#ifdef NDEBUG
constexpr uint32_t kSamples = 1 << 14;
constexpr int kAlphas = 9;
#else
constexpr uint32_t kSamples = 1 << 10;
constexpr int kAlphas = 2;
#endif

// Energy of the whole lobe for light along the normal, the integral of f cos. With x = tan^2(theta_m) / alpha^2 it is
// that of e^-x G1, up to the microfacets that turn light below the horizon.
double exact_energy(double alpha) {
  const double end = std::min(40.0, 1 / (alpha * alpha));
  constexpr int kSteps = 4000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = (i + 0.5) * end / kSteps, t = alpha * std::sqrt(x), tan = 2 * t / (1 - t * t);
    sum += std::exp(-x) / (1 + test::beckmann_lambda(tan, alpha)) * end / kSteps;
  }
  return sum;
}

// The share of the area of the course program's D, which takes no angle for smaller than acos(1 - 1e-5), that is left.
double course_energy(double alpha) {
  const double c2 = (1 - 1e-5) * (1 - 1e-5), s2 = 1 - c2, tan2 = s2 / c2;
  return std::exp(-tan2 / (alpha * alpha)) + std::numbers::pi * s2 * test::beckmann_d(tan2, alpha);
}

// The lobe's energy estimated from directions that shade_microfacet samples and light_microfacet evaluates.
double lobe_energy(double alpha) {
  const std::vector<test::LobeSample> samples = test::sample_lobe({alpha}, 1, kSamples);
  std::vector<glm::dvec3> directions;
  for (const test::LobeSample& sample : samples) directions.push_back(sample.wi);
  const std::vector<double> f_cos = test::evaluate_lobe({alpha}, 1, directions);
  double sum = 0;
  for (uint32_t i = 0; i < kSamples; ++i) sum += samples[i].weight > 0 ? f_cos[i] / samples[i].pdf : 0;
  return sum / kSamples;
}

// A box with a mirror ball, and with a metal ball that reflects as much.
Image picture(const Material& ball) {
  Scene scene = test::test_box();
  scene.materials[test::kMirrorMaterial] = ball;
  Settings settings;
  settings.width = 64, settings.height = 48, settings.threads = 1;
  settings.connect = false;      // of a mirror alone, whose picture would no longer be of the same paths
  settings.light_paths = false;  // by rounding, some would fall into other pixels
  return render(make_plan(scene, settings)).image;
}

Image mirror_picture() {
  Material mirror;
  mirror.kind = Material::Kind::kMirror;
  mirror.reflectance = glm::dvec3(1);
  return picture(mirror);
}

Image metal_picture(double alpha) {
  Material metal;
  metal.kind = Material::Kind::kMicrofacet;
  metal.alpha = alpha;
  metal.eta = metal.k = glm::dvec3(0);
  return picture(metal);
}

// Mean difference of pixel values over their mean.
double difference(const Image& a, const Image& b) {
  double sum = 0, mean = 0;
  for (size_t i = 0; i < a.rgb.size(); ++i) {
    sum += std::abs(double(a.rgb[i]) - double(b.rgb[i]));
    mean += double(b.rgb[i]);
  }
  return sum / mean;
}

}  // namespace

TEST_SUITE_BEGIN("stability");

TEST_CASE("stability: a lobe keeps its energy from alpha = 1 to 1e-5") {
  test::Curve curve{.name = "alpha-to-zero-energy",
                    .title = "Light that a metal which reflects all loses",
                    .naive = "cos θ clamped at 1 − 1e-5 in D (course)",
                    .ours = "D from tangents, " + std::to_string(kSamples) + " samples",
                    .x_axis = "roughness α",
                    .y_axis = "error of the lobe's energy"};
  for (const double alpha : test::log_spaced(1e-5, 1, 21)) {
    test::CurvePoint point{alpha, std::abs(course_energy(alpha) - 1), 0};
    test::for_each_target(
        [&](const char*) { test::take_worst(point.ours, std::abs(lobe_energy(alpha) - exact_energy(alpha))); });
    // All but rounding where no sample is void; five standard deviations of at most 0.4 elsewhere.
    CHECK(point.ours < (alpha < 0.1 ? 2e-5 : 5 * 0.4 / std::sqrt(kSamples)));
    curve.points.push_back(point);
  }
  CHECK(test::beckmann_d(2e-5, 0.005) / test::beckmann_d(0, 0.005) == doctest::Approx(0.45).epsilon(0.01));
  CHECK(curve.worst_naive() > 0.99);
  test::record(curve);
}

TEST_CASE("stability: a polished metal's picture meets the mirror's without a step") {
  // The share of paths that meet something else than the mirror's grows with alpha, and so does the difference.
  test::Curve curve{.name = "alpha-to-zero-mirror",
                    .title = "How fast a metal's picture becomes the mirror's as alpha goes to 0",
                    .naive = "α clamped at 1e-3",
                    .ours = "any α",
                    .x_axis = "roughness α",
                    .y_axis = "mean difference of pixels / mean / α"};
  for (const double alpha : test::log_spaced(1e-5, 1, kAlphas)) curve.points.push_back({alpha, 0, 0});
  test::for_each_target([&](const std::string& target) {
    CAPTURE(target);
    const Image mirror = mirror_picture();
    const double clamped = difference(metal_picture(1e-3), mirror);
    for (test::CurvePoint& point : curve.points) {
      const double ours = difference(metal_picture(point.x), mirror);
      test::take_worst(point.ours, ours / point.x);
      test::take_worst(point.naive, (point.x < 1e-3 ? clamped : ours) / point.x);
    }
    CHECK(difference(metal_picture(0), mirror) < 1e-6);
  });
  CHECK(curve.worst_naive() > 50);  // a step down to the mirror
  CHECK(curve.worst_ours() < 3);
  test::record(curve);
}

TEST_SUITE_END();

}  // namespace lanewise
