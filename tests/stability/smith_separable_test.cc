// There are two of Smith's G for a pair of directions: separable, G1(wo) G1(wi), and height-correlated, 1 / (1 +
// Lambda(wo) + Lambda(wi)). Either is right; what is evaluated and what is sampled must be the same. Here it is the
// separable one.
#include <doctest/doctest.h>

#include "tests/kernel_harness.h"
#include "tests/stability/curve.h"
#include "tests/stability/microfacet_lobe.h"

namespace lanewise {
namespace {

constexpr double kRoughness = 0.5;
constexpr uint32_t kSamples = 4096;

}  // namespace

TEST_SUITE_BEGIN("stability");

TEST_CASE("stability: one G, separable, in what is sampled and what is evaluated") {
  test::Curve curve{.name = "smith-separable",
                    .title = "Sampled weight against evaluated f cos / pdf at alpha = 0.5",
                    .naive = "separable G sampled, height-correlated G evaluated",
                    .ours = "separable G in both",
                    .x_axis = "viewer's angle to the normal (degrees)",
                    .y_axis = "mean relative disagreement",
                    .log_x = false};
  for (int degrees = 0; degrees < 90; degrees += degrees < 80 ? 10 : 3) {
    const double cosine = std::cos(degrees * std::numbers::pi / 180);
    test::CurvePoint point{double(degrees), 0, 0};
    test::for_each_target([&](const char*) {
      const std::vector<test::LobeSample> samples = test::sample_lobe({kRoughness}, cosine, kSamples);
      std::vector<glm::dvec3> directions;
      for (const test::LobeSample& sample : samples) directions.push_back(sample.wi);
      const std::vector<double> f_cos = test::evaluate_lobe({kRoughness}, cosine, directions);
      const double lambda_o = test::beckmann_lambda(test::lobe_viewer(cosine), kRoughness);
      double naive = 0, ours = 0;
      uint32_t valid = 0;
      for (uint32_t i = 0; i < kSamples; ++i) {
        const test::LobeSample& sample = samples[i];
        if (sample.weight == 0) continue;
        const double lambda_i = test::beckmann_lambda(sample.wi, kRoughness);
        const double separable = 1 / ((1 + lambda_o) * (1 + lambda_i)), correlated = 1 / (1 + lambda_o + lambda_i);
        const double evaluated = f_cos[i] / sample.pdf;
        ours += std::abs(evaluated / sample.weight - 1);
        naive += std::abs(evaluated * (correlated / separable) / sample.weight - 1);
        ++valid;
      }
      test::take_worst(point.naive, naive / valid);
      test::take_worst(point.ours, ours / valid);
    });
    curve.points.push_back(point);
  }
  CHECK(curve.worst_naive() > 0.05);
  CHECK(curve.worst_ours() < 1e-6);
  test::record(curve);
}

TEST_CASE("stability: the two of Smith's G at grazing angles are not to be mistaken for each other") {
  const auto ratio = [](double degrees) {  // correlated over separable, there and back along one direction
    const double lambda = test::beckmann_lambda(std::tan(degrees * std::numbers::pi / 180), kRoughness);
    return (1 + lambda) * (1 + lambda) / (1 + 2 * lambda);
  };
  CHECK(ratio(60) < 1.02);
  CHECK(ratio(85) > 1.3);
}

TEST_SUITE_END();

}  // namespace lanewise
