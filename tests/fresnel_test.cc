#include <doctest/doctest.h>

#include <cmath>
#include <complex>

#include "core/verify/exact_functions.h"
#include "kernels/reference/fresnel.h"
#include "tests/fresnel_harness.h"
#include "tests/kernel_harness.h"

namespace lanewise {
namespace {

using Complex = std::complex<double>;
using Inputs = test::FresnelInputs;
using Outputs = test::DielectricOutputs;
using test::conductors;
using test::dielectrics;
using verify::fresnel_equations;

const std::vector<float> kCosines = {1,    0.9999999f, 0.99f, 0.9f,  0.8f,  0.7454f, 0.7f,    0.6f,
                                     0.5f, 0.3f,       0.2f,  0.05f, 0.01f, 1.7e-3f, 1.7e-4f, 1e-6f};

double schlick(double f0, double c) { return f0 + (1 - f0) * std::pow(1 - c, 5); }

}  // namespace

TEST_CASE("fresnel: exact dielectrics against the equations in complex double, from both sides") {
  Inputs in;
  for (const float ior : {1.0001f, 1.01f, 1.1f, 1.33f, 1.45f, 1.5f, 2.5f, 10.0f}) {
    for (const float c : kCosines) {
      in.add(c, 1, ior);
      in.add(c, ior, 1);
    }
  }
  test::for_each_target([&](const std::string& target) {
    CAPTURE(target);
    const Outputs out = dielectrics(Fresnel::kExact, in);
    for (size_t i = 0; i < in.c.size(); ++i) {
      const double c = in.c[i], n_i = in.a[i], n_t = in.b[i];
      CAPTURE(c);
      CAPTURE(n_i);
      CAPTURE(n_t);
      const double g2 = n_t * n_t - n_i * n_i * (1 - c * c);
      if (g2 <= 0) {
        CHECK(out.f[i] == 1);
        CHECK(out.cos_t[i] == 0);
        continue;
      }
      // The root makes errors of g2 large near the critical angle.
      const double slack = 2e-6 * std::max(1.0, 0.1 * n_i * n_i / g2);
      const double want = fresnel_equations(c, n_t / n_i);
      CHECK(std::abs(out.f[i] - want) <= slack * want + 1e-9);
      CHECK(std::abs(out.cos_t[i] - std::sqrt(g2) / n_t) <= slack);
      CHECK(out.f[i] ==
            doctest::Approx(reference::fresnel_dielectric(Fresnel::kExact, c, n_i, n_t).reflectance).epsilon(slack));
    }
  });
}

TEST_CASE("fresnel: total internal reflection is exactly 1 and is met without a step") {
  for (const Fresnel model : {Fresnel::kExact, Fresnel::kSchlick, Fresnel::kCourse}) {
    Inputs in;
    const float critical = static_cast<float>(std::sqrt(1 - 1 / (1.5 * 1.5)));
    float c = critical;
    for (int i = 0; i < 4; ++i) c = std::nextafter(c, 0.0f);
    for (int i = -4; i <= 4; ++i, c = std::nextafter(c, 1.0f)) in.add(c, 1.5f, 1);
    for (const float beyond : {0.7f, 0.3f, 1e-3f, 0.0f}) in.add(beyond, 1.5f, 1);
    test::for_each_target([&](const std::string& target) {
      CAPTURE(target);
      const Outputs out = dielectrics(model, in);
      for (size_t i = 0; i < 9; ++i) {
        CHECK(out.f[i] <= 1);
        if (model != Fresnel::kCourse) CHECK(out.f[i] > 0.985);
        if (i > 0 && model != Fresnel::kCourse) CHECK(out.f[i] <= out.f[i - 1]);
      }
      for (size_t i = 9; i < 13; ++i) {
        CHECK(out.f[i] == 1);
        CHECK(out.cos_t[i] == 0);
      }
    });
  }
}

TEST_CASE("fresnel: dielectrics reflect alike along a path and back, and 1 at grazing, 0 where indices match") {
  Inputs there, back;
  for (const float c : kCosines) there.add(c, 1, 1.5f);
  test::for_each_target([&](const std::string& target) {
    CAPTURE(target);
    for (const Fresnel model : {Fresnel::kExact, Fresnel::kSchlick}) {
      const Outputs out = dielectrics(model, there);
      back = {};
      for (size_t i = 0; i < there.c.size(); ++i) back.add(out.cos_t[i], 1.5f, 1);
      const Outputs returned = dielectrics(model, back);
      for (size_t i = 0; i < there.c.size(); ++i) {
        if (there.c[i] > 1e-3f) CHECK(returned.f[i] == doctest::Approx(out.f[i]).epsilon(2e-4));
      }
    }
    Inputs limits;
    limits.add(0, 1, 1.5f);
    limits.add(0.5f, 1.3f, 1.3f);
    const Outputs out = dielectrics(Fresnel::kExact, limits);
    CHECK(out.f[0] == 1);
    CHECK(out.f[1] == 0);
    CHECK(out.cos_t[1] == doctest::Approx(0.5));
  });
}

TEST_CASE("fresnel: exact conductors against the equations in complex double") {
  Inputs in;
  const float metals[][2] = {
      {0.21646f, 3.2390f}, {1.3284f, 1.8661f}, {0.059193f, 4.1283f}, {1.3352f, 7.3398f}, {0.5f, 0.5f}, {1.5f, 0},
      {0.7f, 0},           {1.0001f, 0},       {1, 1e-3f},           {1e-3f, 1},         {4, 1e-4f},   {100, 100}};
  for (const auto& metal : metals) {
    for (const float c : kCosines) in.add(c, metal[0], metal[1]);
  }
  test::for_each_target([&](const std::string& target) {
    CAPTURE(target);
    const std::vector<float> f = conductors(Fresnel::kExact, in);
    for (size_t i = 0; i < in.c.size(); ++i) {
      const double c = in.c[i], eta = in.a[i], k = in.b[i];
      CAPTURE(c);
      CAPTURE(eta);
      CAPTURE(k);
      const double want = fresnel_equations(c, Complex(eta, k));
      CHECK(std::abs(f[i] - want) < 4e-6);
      CHECK(f[i] == doctest::Approx(reference::fresnel_conductor(Fresnel::kExact, c, eta, k)).epsilon(1e-5));
    }
  });
}

TEST_CASE("fresnel: conductors without index or extinction stay finite, in [0, 1] and in line with dielectrics") {
  Inputs in;
  for (const float c : kCosines) {
    in.add(c, 0, 0);
    in.add(c, 1, 0);
    in.add(c, 0, 2);
    in.add(c, 1.5f, 0);
  }
  test::for_each_target([&](const std::string& target) {
    CAPTURE(target);
    for (const Fresnel model : {Fresnel::kExact, Fresnel::kSchlick, Fresnel::kCourse}) {
      const std::vector<float> f = conductors(model, in);
      for (size_t i = 0; i < in.c.size(); ++i) {
        CAPTURE(in.c[i]);
        CHECK(f[i] >= 0);
        CHECK(f[i] <= 1);
        if (model != Fresnel::kExact) continue;
        if (in.a[i] == 0) CHECK(f[i] == 1);
        if (in.a[i] == 1 && in.c[i] > 1e-3f) CHECK(f[i] < 1e-6);
        if (in.a[i] == 1.5f) CHECK(f[i] == doctest::Approx(fresnel_equations(in.c[i], 1.5)).epsilon(1e-5));
      }
    }
  });
}

TEST_CASE("fresnel: Schlick's and the course's forms are what they say, with their known errors") {
  test::for_each_target([&](const std::string& target) {
    CAPTURE(target);
    Inputs glass, metal;
    glass.add(0.5f, 1, 1.5f);
    glass.add(0.9f, 1.5f, 1);
    metal.add(0.5f, 0.5f, 0.5f);
    metal.add(0.7f, 0.21646f, 3.2390f);
    const Outputs schlick_glass = dielectrics(Fresnel::kSchlick, glass),
                  course_glass = dielectrics(Fresnel::kCourse, glass);
    const double cos_t = std::sqrt(1 - 2.25 * (1 - 0.81));
    CHECK(schlick_glass.f[0] == doctest::Approx(schlick(0.04, 0.5)).epsilon(1e-6));
    CHECK(schlick_glass.f[1] == doctest::Approx(schlick(0.04, cos_t)).epsilon(1e-5));
    CHECK(course_glass.f[0] == schlick_glass.f[0]);
    CHECK(course_glass.f[1] == doctest::Approx(schlick(0.04, 0.9)).epsilon(1e-6));

    const std::vector<float> schlick_metal = conductors(Fresnel::kSchlick, metal);
    const double f0 = (0.25 + 0.25) / (2.25 + 0.25);
    CHECK(schlick_metal[0] == doctest::Approx(schlick(f0, 0.5)).epsilon(1e-6));

    // The course's form is within .007 for gold and as much as .22 off at n = k = .5.
    Inputs gold, half;
    for (const float c : kCosines) gold.add(c, 0.21646f, 3.2390f), half.add(c, 0.5f, 0.5f);
    const std::vector<float> course_gold = conductors(Fresnel::kCourse, gold),
                             course_half = conductors(Fresnel::kCourse, half);
    double gold_error = 0, half_error = 0;
    for (size_t i = 0; i < kCosines.size(); ++i) {
      gold_error = std::max(gold_error, std::abs(course_gold[i] - fresnel_equations(kCosines[i], {0.21646, 3.2390})));
      half_error = std::max(half_error, std::abs(course_half[i] - fresnel_equations(kCosines[i], {0.5, 0.5})));
    }
    CHECK(gold_error < 0.007);
    CHECK(half_error == doctest::Approx(0.22).epsilon(0.05));
  });
}

}  // namespace lanewise
