// Beckmann's D hangs on tan^2 of the half vector. For a polished metal that is far below one rounding error of the
// cosine, from which it is often computed.
#include <doctest/doctest.h>

#include "tests/kernel_harness.h"
#include "tests/stability/curve.h"
#include "tests/stability/microfacet_lobe.h"

namespace lanewise {
namespace {

using glm::dvec3;

// As the formula is mostly written: tan^2 = (1 - cos^2) / cos^2.
float naive_d(float cosine, float alpha) {
  const float cosine2 = cosine * cosine, tan2 = (1 - cosine2) / cosine2;
  return std::exp(-tan2 / (alpha * alpha)) / (3.14159265f * alpha * alpha * cosine2 * cosine2);
}

}  // namespace

TEST_SUITE_BEGIN("stability");

TEST_CASE("stability: Beckmann's D of polished metals") {
  test::Curve curve{.name = "beckmann-tan2",
                    .title = "Beckmann's D at theta = alpha, for polished metals",
                    .naive = "tan² from 1 − cos², float",
                    .ours = "tan² from the half vector's parts",
                    .x_axis = "roughness α",
                    .y_axis = "relative error of D"};
  for (const double alpha : test::log_spaced(1e-5, 1, 41)) {
    // Seen and lit along m, at theta = alpha to the normal: the half vector is m itself.
    const dvec3 wo = test::lobe_viewer(std::cos(alpha)), m = glm::normalize(wo);
    const double a = static_cast<float>(alpha), tan2 = (m.x * m.x) / (m.z * m.z), d = test::beckmann_d(tan2, a);
    const double g1 = test::smith_g1(wo, a), want = d * g1 * g1 / (4 * wo.z);
    test::CurvePoint point{alpha, std::abs(naive_d(static_cast<float>(m.z), static_cast<float>(a)) / d - 1), 0};
    test::for_each_target([&](const char*) {
      const double got = test::evaluate_lobe({alpha}, std::cos(alpha), {wo})[0];
      point.ours = std::max(point.ours, std::abs(got / want - 1));
    });
    curve.points.push_back(point);
    if (std::abs(alpha - 1e-3) < 1e-9) CHECK(point.naive > 0.03);
    if (alpha < 3e-5) CHECK(point.naive > 1.7);  // e - 1: the cosine is 1, and D that of theta = 0
  }
  CHECK(curve.worst_naive() > 1.7);
  CHECK(curve.worst_ours() < 3e-6);
  test::record(curve);
}

TEST_SUITE_END();

}  // namespace lanewise
