// Beckmann's D hangs on tan^2 of the half vector. For a polished metal that is far below one rounding error of the
// cosine, from which it is often computed.
#include <doctest/doctest.h>

#include <random>

#include "kernels/kernels.h"
#include "tests/kernel_harness.h"
#include "tests/shading_harness.h"
#include "tests/stability/curve.h"
#include "tests/stability/microfacet_lobe.h"
#include "tests/trace_plan.h"

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
      test::take_worst(point.ours, std::abs(got / want - 1));
    });
    curve.points.push_back(point);
    if (std::abs(alpha - 1e-3) < 1e-9) CHECK(point.naive > 0.03);
    if (alpha < 3e-5) CHECK(point.naive > 1.7);  // e - 1: the cosine is 1, and D that of theta = 0
  }
  CHECK(curve.worst_naive() > 1.7);
  CHECK(curve.worst_ours() < 3e-6);
  test::record(curve);
}

TEST_CASE("stability: Beckmann's D of polished metals that face anywhere") {
  // Directions are rounded to 2^-24 here, which a lobe of width alpha feels as 2^-24 / alpha.
  test::Curve curve{.name = "beckmann-tan2-tilted",
                    .title = "Beckmann's D at theta = alpha, for polished metals that face anywhere",
                    .naive = "tan² from 1 − cos², float",
                    .ours = "tan² from the half vector's parts",
                    .x_axis = "roughness α",
                    .y_axis = "relative error of D, worst of 64"};
  constexpr uint32_t kNormals = 64;
  for (const double alpha : test::log_spaced(1e-5, 1, 21)) {
    CAPTURE(alpha);
    Settings settings;
    settings.direct = Direct::kLight;
    const Plan plan = test::material_plan({test::white_metal(static_cast<float>(alpha))}, settings);
    test::CurvePoint point{alpha, 0, 0};
    std::mt19937 rng(3);
    PathBuffer paths(kNormals);
    const PathState& s = paths.state();
    std::vector<double> want;
    for (uint32_t i = 0; i < kNormals; ++i) {
      const dvec3 n(test::random_direction(rng)),
          side(glm::normalize(glm::cross(n, dvec3(test::random_direction(rng)))));
      const glm::vec3 m(std::cos(alpha) * n + std::sin(alpha) * side);  // seen and lit along it
      Path<float> p;
      p.d_x = -m.x, p.d_y = -m.y, p.d_z = -m.z;
      p.l_x = m.x, p.l_y = m.y, p.l_z = m.z;
      p.s_x = static_cast<float>(n.x), p.s_y = static_cast<float>(n.y), p.s_z = static_cast<float>(n.z);
      p.beta_g = p.l_pdf = 1;
      store_path(s, i, p);
      const dvec3 exact_n = glm::normalize(dvec3(p.s_x, p.s_y, p.s_z)), exact_m = glm::normalize(dvec3(m));
      const double cosine = glm::dot(exact_m, exact_n), tan = glm::length(glm::cross(exact_m, exact_n)) / cosine;
      const double a = static_cast<float>(alpha), d = test::beckmann_d(tan * tan, a);
      const double g1 = 1 / (1 + test::beckmann_lambda(tan, a));
      want.push_back(double(plan.lights[0].radiance[1]) * d * g1 * g1 / (4 * cosine));
      const float float_cosine = glm::dot(m, glm::vec3(p.s_x, p.s_y, p.s_z));
      const double naive = double(naive_d(std::min(float_cosine, 1.0f), static_cast<float>(a)));
      test::take_worst(point.naive, std::abs(naive / d - 1));
    }
    test::for_each_target([&](const char*) {
      light_microfacet(plan, s, {0, kNormals});
      for (uint32_t i = 0; i < kNormals; ++i) {
        test::take_worst(point.ours, std::abs(double(s.c_g[i]) / want[i] - 1));
      }
    });
    CHECK(point.ours < (3 / alpha + 12) * 0x1p-24);
    curve.points.push_back(point);
  }
  CHECK(curve.worst_naive() > 1.7);
  test::record(curve);
}

TEST_SUITE_END();

}  // namespace lanewise
