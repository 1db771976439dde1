// --model: the course program's microfacet lobe, written here as it has it: by angles.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/kernel_harness.h"
#include "tests/shading_harness.h"
#include "tests/stability/microfacet_lobe.h"

namespace lanewise {
namespace {

constexpr CourseLobe kBoth = {.masking = true, .clamp = true};

double theta_of(double cosine) { return std::acos(std::clamp(cosine, -1 + 1e-5, 1 - 1e-5)); }

double course_lambda(double cosine, double alpha) {
  const double a = 1 / (alpha * std::tan(theta_of(cosine)));
  return 0.5 * (std::erf(a) - 1 + std::exp(-a * a) / (a * std::numbers::pi));
}

double course_d(double cosine, double alpha) {
  const double theta = theta_of(cosine), tan = std::tan(theta);
  return std::exp(-tan * tan / (alpha * alpha)) / (std::numbers::pi * alpha * alpha * std::pow(std::cos(theta), 4));
}

double course_f_cos(const glm::dvec3& wo, const glm::dvec3& wi, double alpha) {
  const double g = 1 / (1 + course_lambda(wi.z, alpha) + course_lambda(wo.z, alpha));
  return g * course_d(glm::normalize(wo + wi).z, alpha) / (4 * wo.z);
}

glm::dvec3 at(double degrees) {
  const double theta = degrees * std::numbers::pi / 180;
  return {std::sin(theta), 0, std::cos(theta)};
}

}  // namespace

TEST_CASE("course model: its lobe, by light samples") {
  std::vector<glm::dvec3> wi;
  for (int degrees = -84; degrees <= 84; degrees += 12) wi.push_back(at(degrees));
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    for (const double alpha : {0.1, 0.5}) {
      for (const double cosine : {0.99, 0.7, 0.15}) {
        const glm::dvec3 wo = test::lobe_viewer(cosine);
        const auto f_cos = test::evaluate_lobe({.alpha = alpha, .course = kBoth}, cosine, wi);
        for (size_t i = 0; i < wi.size(); ++i) {
          CAPTURE(i);
          CHECK(f_cos[i] == doctest::Approx(course_f_cos(wo, wi[i], alpha)).epsilon(1e-4).scale(1e-6));
        }
      }
    }
  });
}

TEST_CASE("course model: by how much it departs") {
  // D at the normal, of polished metal.
  for (const auto& [alpha, share] : {std::pair{0.005, 0.45}, {0.002, 0.007}}) {
    const auto ratio = [&, alpha = alpha](const CourseLobe& course) {
      return test::evaluate_lobe({.alpha = alpha, .course = course}, 1, {at(0)})[0];
    };
    CHECK(ratio({.clamp = true}) / ratio({}) == doctest::Approx(share).epsilon(0.02));
  }
  // G1 at 85 degrees, the light along the normal. D is the same.
  const double wide = std::cos(85 * std::numbers::pi / 180);
  const auto f_cos = [&](const CourseLobe& course) {
    return test::evaluate_lobe({.alpha = 0.5, .course = course}, wide, {at(0)})[0];
  };
  CHECK(f_cos({.masking = true}) / f_cos({}) == doctest::Approx(0.676 / 0.463).epsilon(0.003));
}

TEST_CASE("course model: samples of every strategy weigh what the lobe says") {
  for (const BsdfSampling sampling : {BsdfSampling::kVndf, BsdfSampling::kNdf, BsdfSampling::kCosine}) {
    const test::Lobe lobe = {.alpha = 0.3, .sampling = sampling, .course = kBoth};
    const glm::dvec3 wo = test::lobe_viewer(0.6);
    for (const test::LobeSample& sample : test::sample_lobe(lobe, 0.6, 1024)) {
      if (sample.weight == 0 || sample.wi.z < 1e-3) continue;
      CHECK(sample.weight * sample.pdf == doctest::Approx(course_f_cos(wo, sample.wi, 0.3)).epsilon(2e-3));
    }
  }
}

TEST_CASE("course model: SIMD against its twin") {
  for (const CourseLobe& course : {CourseLobe{.masking = true}, CourseLobe{.clamp = true}, kBoth}) {
    for (const BsdfSampling sampling : {BsdfSampling::kVndf, BsdfSampling::kNdf, BsdfSampling::kCosine}) {
      Settings settings;
      settings.bsdf_sampling = sampling;
      settings.fresnel = Fresnel::kCourse;
      settings.course = course;
      const Plan plan = test::material_plan({test::gold(0.1f), test::gold(0.4f), test::gold(1)}, settings);
      test::check_kernel(plan, "shade_microfacet");
      test::check_kernel(plan, "light_microfacet");
    }
  }
}

}  // namespace lanewise
