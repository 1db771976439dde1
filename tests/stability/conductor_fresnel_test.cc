// Two short cuts for the reflectance of conductors: eta^2 + k^2 for the complex root, which needs one of the two to be
// large, and Schlick's, which knows no dip before grazing angles.
#include <doctest/doctest.h>

#include <cmath>

#include "core/verify/exact_functions.h"
#include "tests/fresnel_harness.h"
#include "tests/kernel_harness.h"
#include "tests/stability/curve.h"

namespace lanewise {
namespace {

double exact(double c, double eta, double k) { return verify::fresnel_equations(c, {eta, k}); }

// The course program's.
double large_index(double c, double eta, double k) {
  const double m2 = eta * eta + k * k, cross = 2 * eta * c;
  const double rs = (m2 - cross + c * c) / (m2 + cross + c * c);
  const double rp = (m2 * c * c - cross + 1) / (m2 * c * c + cross + 1);
  return (rs + rp) / 2;
}

double schlick(double c, double eta, double k) {
  const double f0 = ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k);
  return f0 + (1 - f0) * std::pow(1 - c, 5);
}

// The largest absolute error over all angles.
double worst(double (*reflectance)(double, double, double), double eta, double k) {
  double error = 0;
  for (double c = 0; c <= 1; c += 1.0 / 512)
    test::take_worst(error, std::abs(reflectance(c, eta, k) - exact(c, eta, k)));
  return error;
}

double worst_of_kernels(double eta, double k) {
  test::FresnelInputs in;
  for (double c = 0; c <= 1; c += 1.0 / 512)
    in.add(static_cast<float>(c), static_cast<float>(eta), static_cast<float>(k));
  double error = 0;
  test::for_each_target([&](const char*) {
    const std::vector<float> f = test::conductors(Settings().fresnel, in);
    for (size_t i = 0; i < in.c.size(); ++i) test::take_worst(error, std::abs(f[i] - exact(in.c[i], in.a[i], in.b[i])));
  });
  return error;
}

struct Metal {
  const char* name;
  double eta, k;  // at 614 nm
};

}  // namespace

TEST_SUITE_BEGIN("stability");

TEST_CASE("stability: short cuts for the reflectance of conductors") {
  test::Curve course{.name = "conductor-fresnel",
                     .title = "Large-index reflectance of a conductor with eta = k: worst angle",
                     .naive = "large-index form, η² + k² (--fresnel course)",
                     .ours = "exact complex root (default)",
                     .x_axis = "η = k",
                     .y_axis = "absolute error of F"};
  test::Curve approximate = course;
  approximate.name = "conductor-schlick";
  approximate.title = "Schlick's reflectance of a conductor with eta = k: worst angle";
  approximate.naive = "Schlick with exact F0 (--fresnel schlick)";
  for (const double index : test::log_spaced(0.05, 20, 27)) {
    const double ours = worst_of_kernels(index, index);
    course.points.push_back({index, worst(large_index, index, index), ours});
    approximate.points.push_back({index, worst(schlick, index, index), ours});
  }
  CHECK(worst(large_index, 0.5, 0.5) > 0.2);
  CHECK(worst(schlick, 0.5, 0.5) > 0.1);
  CHECK(course.worst_ours() < 1e-6);
  test::record(course);
  test::record(approximate);
}

TEST_CASE("stability: the short cuts for real metals") {
  // Close enough to be on offer, not to be the default.
  for (const Metal& m : {Metal{"Cu", 0.33228, 3.1646}, Metal{"Au", 0.21646, 3.2390}, Metal{"Al", 1.3352, 7.3398},
                         Metal{"Cr", 3.1071, 3.3314}, Metal{"W", 3.6, 2.9}}) {
    CAPTURE(m.name);
    CHECK(worst(large_index, m.eta, m.k) > 1e-3);
    CHECK(worst(large_index, m.eta, m.k) < 0.02);
    CHECK(worst(schlick, m.eta, m.k) > 0.01);
    CHECK(worst_of_kernels(m.eta, m.k) < 1e-6);
  }
}

TEST_SUITE_END();

}  // namespace lanewise
