// Which directions a microfacet is given decides the noise: all normals waste samples at grazing angles, the cosine
// knows nothing of a narrow lobe. All three ways are unbiased, and offered.
#include <doctest/doctest.h>

#include "tests/kernel_harness.h"
#include "tests/stability/curve.h"
#include "tests/stability/microfacet_lobe.h"

namespace lanewise {
namespace {

#ifdef NDEBUG
constexpr uint32_t kSamples = 1 << 14;
#else
constexpr uint32_t kSamples = 1 << 11;
#endif

struct Weights {
  double mean, variance, largest, rejected;  // variance over mean^2
};

Weights weights(const test::Lobe& lobe, double cosine) {
  Weights w{};
  double sum2 = 0;
  for (const test::LobeSample& sample : test::sample_lobe(lobe, cosine, kSamples)) {
    w.mean += sample.weight / kSamples;
    sum2 += sample.weight * sample.weight / kSamples;
    w.largest = std::max(w.largest, sample.weight);
    w.rejected += (sample.weight == 0) / double(kSamples);
  }
  w.variance = sum2 / (w.mean * w.mean) - 1;
  return w;
}

double cosine_of(double degrees) { return std::cos(degrees * std::numbers::pi / 180); }

}  // namespace

TEST_SUITE_BEGIN("stability");

TEST_CASE("stability: the noise of sampling all normals, at grazing angles") {
  test::Curve curve{.name = "normal-sampling",
                    .title = "Noise of a sampled direction at alpha = 0.25",
                    .naive = "all normals (--bsdf-sampling ndf)",
                    .ours = "visible normals (default)",
                    .x_axis = "viewer's angle to the normal (degrees)",
                    .y_axis = "variance of the weight / mean²",
                    .log_x = false};
  for (int degrees = 0; degrees < 90; degrees += degrees < 80 ? 10 : 2) {
    const Weights all = weights({0.25, BsdfSampling::kNdf}, cosine_of(degrees));
    test::CurvePoint point{double(degrees), all.variance, 0};
    test::for_each_target([&](const char*) {
      const Weights visible = weights({0.25}, cosine_of(degrees));
      test::take_worst(point.ours, visible.variance);
      CHECK(visible.largest <= 1.000001);
      CHECK(visible.mean == doctest::Approx(all.mean).epsilon(5 * std::sqrt(all.variance / kSamples)));
    });
    curve.points.push_back(point);
  }
  const Weights all = weights({0.25, BsdfSampling::kNdf}, cosine_of(85)), visible = weights({0.25}, cosine_of(85));
  CHECK(all.rejected == doctest::Approx(0.41).epsilon(0.1));
  CHECK(all.largest > 5);
  CHECK(visible.rejected < 0.1);
  CHECK(curve.worst_naive() > 1.5);
  CHECK(curve.worst_ours() < 0.3);
  test::record(curve);
}

TEST_CASE("stability: the noise of sampling a narrow lobe by the cosine") {
  test::Curve curve{.name = "cosine-sampling",
                    .title = "Noise of a sampled direction, seen along the normal",
                    .naive = "cosine (--bsdf-sampling cosine)",
                    .ours = "visible normals (default)",
                    .x_axis = "roughness α",
                    .y_axis = "variance of the weight / mean²"};
  for (const double alpha : test::log_spaced(0.03, 1, 11)) {
    test::CurvePoint point{alpha, weights({alpha, BsdfSampling::kCosine}, 1).variance, 0};
    test::for_each_target([&](const char*) { test::take_worst(point.ours, weights({alpha}, 1).variance); });
    curve.points.push_back(point);
  }
  CHECK(weights({0.05, BsdfSampling::kCosine}, 1).variance > 40);
  // Rough metals are the exception: there multiple importance sampling with the light makes up for it.
  CHECK(weights({0.5, BsdfSampling::kCosine}, 1).variance < weights({0.5}, 1).variance);
  CHECK(curve.worst_naive() > 100);
  CHECK(curve.points.front().ours < 1e-6);
  CHECK(curve.worst_ours() < 1);
  test::record(curve);
}

TEST_SUITE_END();

}  // namespace lanewise
