// Smith's shadowing in a formula with a slip that has been rendered with: pi for its square root.
#include <doctest/doctest.h>

#include "tests/kernel_harness.h"
#include "tests/stability/curve.h"
#include "tests/stability/microfacet_lobe.h"

namespace lanewise {
namespace {

constexpr double kDegree = std::numbers::pi / 180, kRoughness = 0.5;

// The course program's.
double course_lambda(double theta) {
  const double a = 1 / (kRoughness * std::tan(theta));
  return (std::erf(a) - 1 + std::exp(-a * a) / (a * std::numbers::pi)) / 2;
}

double exact_g1(double theta) { return 1 / (1 + test::beckmann_lambda(std::tan(theta), kRoughness)); }

}  // namespace

TEST_SUITE_BEGIN("stability");

TEST_CASE("stability: Smith's G1 from grazing directions") {
  constexpr int kStep = 3;  // degrees of a point of the curve
  test::Curve curve{.name = "smith-lambda",
                    .title = "Smith's shadowing G1 at alpha = 0.5",
                    .naive = "Λ with π for √π (course)",
                    .ours = "exact Λ",
                    .x_axis = "angle to the normal (degrees)",
                    .y_axis = "absolute error of G1",
                    .log_x = false};
  double highest = 0;
  for (int degrees = kStep; degrees < 90; degrees += kStep) {
    const double theta = degrees * kDegree;
    curve.points.push_back({double(degrees), std::abs(1 / (1 + course_lambda(theta)) - exact_g1(theta)), 0});
    highest = std::max(highest, 1 / (1 + 2 * course_lambda(theta)));  // G(w, w)
  }
  // Of visible normals the weight of a sample is G1 of the direction that it takes.
  test::for_each_target([&](const char*) {
    for (const double cosine : {0.9, 0.5, 0.1}) {
      for (const test::LobeSample& sample : test::sample_lobe({kRoughness, BsdfSampling::kVndf}, cosine, 16384)) {
        if (sample.weight == 0) continue;
        const double theta = std::atan2(std::hypot(sample.wi.x, sample.wi.y), sample.wi.z);
        const size_t bin = static_cast<size_t>(std::lround(theta / kDegree / kStep));
        double& error = curve.points[std::clamp<size_t>(bin, 1, curve.points.size()) - 1].ours;
        test::take_worst(error, std::abs(sample.weight - exact_g1(theta)));
      }
    }
  });
  CHECK(exact_g1(85 * kDegree) == doctest::Approx(0.463).epsilon(0.002));
  CHECK(1 / (1 + course_lambda(85 * kDegree)) == doctest::Approx(0.676).epsilon(0.002));
  CHECK(highest > 1.04);  // more light than there is
  CHECK(curve.worst_naive() > 0.2);
  CHECK(curve.worst_ours() < 2e-6);
  test::record(curve);
}

TEST_SUITE_END();

}  // namespace lanewise
