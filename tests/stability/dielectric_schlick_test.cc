// Schlick's approximation was made for metals and glass; towards index 1 its F0 + (1 - F0)(1 - c)^5 keeps a glare that
// Fresnel's equations have not.
#include <doctest/doctest.h>

#include <cmath>

#include "core/verify/exact_functions.h"
#include "tests/fresnel_harness.h"
#include "tests/kernel_harness.h"
#include "tests/stability/curve.h"

namespace lanewise {
namespace {

double schlick(double c, double index) {
  const double root = (index - 1) / (index + 1), f0 = root * root;
  return f0 + (1 - f0) * std::pow(1 - c, 5);
}

double fresnel(double c, double index) { return verify::fresnel_equations(c, index); }

// The share that is reflected of light that comes evenly from everywhere.
template <class F>
double albedo(const F& reflectance, double index) {
  constexpr int kSteps = 20000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double c = (i + 0.5) / kSteps;
    sum += 2 * c * reflectance(c, index) / kSteps;
  }
  return sum;
}

}  // namespace

TEST_SUITE_BEGIN("stability");

TEST_CASE("stability: Schlick's approximation of dielectrics") {
  test::Curve curve{.name = "dielectric-schlick",
                    .title = "Reflectance of a dielectric: worst angle from 0 to 89 degrees",
                    .naive = "Schlick (--fresnel schlick)",
                    .ours = "exact, factored (default)",
                    .x_axis = "index of refraction − 1",
                    .y_axis = "relative error of F"};
  for (const double excess : test::log_spaced(1e-4, 2, 31)) {
    const float index = static_cast<float>(1 + excess);
    test::FresnelInputs in;
    for (int degrees = 0; degrees < 90; ++degrees) {
      in.add(static_cast<float>(std::cos(degrees * std::numbers::pi / 180)), 1, index);
    }
    test::CurvePoint point{excess, 0, 0};
    for (const float c : in.c) test::take_worst(point.naive, std::abs(schlick(c, index) / fresnel(c, index) - 1));
    test::for_each_target([&](const char*) {
      const test::DielectricOutputs out = test::dielectrics(Settings().fresnel, in);
      for (size_t i = 0; i < in.c.size(); ++i) {
        test::take_worst(point.ours, std::abs(out.f[i] / fresnel(in.c[i], index) - 1));
      }
    });
    curve.points.push_back(point);
  }
  const auto at_most = [](double index) {
    double worst = 0;
    for (double c = 0.02; c <= 1; c += 0.01)
      test::take_worst(worst, std::abs(schlick(c, index) / fresnel(c, index) - 1));
    return worst;
  };
  CHECK(at_most(1.33) > 0.2);
  CHECK(at_most(1.5) > 0.2);
  CHECK(at_most(1.5) < 0.25);
  CHECK(albedo(schlick, 1.1) / albedo(fresnel, 1.1) > 1.9);
  CHECK(albedo(schlick, 1.01) / albedo(fresnel, 1.01) > 14);
  CHECK(curve.worst_naive() > 1000);
  CHECK(curve.worst_ours() < 5e-6);
  test::record(curve);
}

TEST_SUITE_END();

}  // namespace lanewise
