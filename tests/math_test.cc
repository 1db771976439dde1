#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/math_test.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/math-inl.h"

#ifndef LANEWISE_TESTS_MATH_TEST_FUNCTIONS_
#define LANEWISE_TESTS_MATH_TEST_FUNCTIONS_
namespace lanewise {
enum class MathFunction { kSin2Pi, kCos2Pi, kExp, kLog, kErfcx, kErfInvCentered };
}  // namespace lanewise
#endif

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// y[i] = f(x[i]) for i < n, n a multiple of kLanes.
void Apply(MathFunction f, const float* x, size_t n, float* y) {
  const DF d;
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    const VF in = hn::LoadU(d, x + i);
    VF out = in, other;
    switch (f) {
      case MathFunction::kSin2Pi:
        SinCos2Pi(in, out, other);
        break;
      case MathFunction::kCos2Pi:
        SinCos2Pi(in, other, out);
        break;
      case MathFunction::kExp:
        out = Exp(in);
        break;
      case MathFunction::kLog:
        out = Log(in);
        break;
      case MathFunction::kErfcx:
        out = Erfcx(in);
        break;
      case MathFunction::kErfInvCentered:
        out = ErfInvCentered(in);
        break;
    }
    hn::StoreU(out, d, y + i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/kernel_harness.h"

namespace lanewise {
namespace {

HWY_EXPORT(Apply);

std::vector<float> apply(MathFunction f, std::vector<float> x) {
  const size_t n = x.size();
  x.resize(round_up_to_lanes(static_cast<uint32_t>(n)), x.back());
  std::vector<float> y(x.size());
  HWY_DYNAMIC_DISPATCH(Apply)(f, x.data(), x.size(), y.data());
  y.resize(n);
  return y;
}

// Every stride-th float from lo to hi, which have the same sign, by bit pattern, and hi itself.
std::vector<float> every_float(float lo, float hi, uint32_t stride) {
  std::vector<float> x;
  const uint32_t first = std::bit_cast<uint32_t>(lo), last = std::bit_cast<uint32_t>(hi);
  for (uint64_t bits = first; bits < last; bits += stride)
    x.push_back(std::bit_cast<float>(static_cast<uint32_t>(bits)));
  x.push_back(hi);
  return x;
}

double ulp(double exact) {
  const double smallest = std::numeric_limits<float>::min();
  return std::ldexp(1.0, std::ilogb(std::max(std::abs(exact), smallest)) - 23);
}

void check_ulps(const std::string& name, MathFunction f, double (*exact)(double), const std::vector<float>& x,
                double bound) {
  std::vector<double> want(x.size());
  for (size_t i = 0; i < x.size(); ++i) want[i] = exact(double(x[i]));
  test::for_each_target([&](const std::string& target) {
    const std::vector<float> got = apply(f, x);
    double worst = 0;
    float at = 0;
    for (size_t i = 0; i < x.size(); ++i) {
      const double error = std::abs(got[i] - want[i]) / ulp(want[i]);
      if (!(error <= worst)) worst = error, at = x[i];
    }
    CAPTURE(name);
    CAPTURE(target);
    CAPTURE(at);
    CHECK(worst <= bound);
  });
}

// By reduction to an eighth of a turn, exact in double: near its zeros the sine of a rounded 2 pi u means nothing.
double sin_2pi(double u) {
  const double quarter = std::round(4 * u), x = (u - quarter / 4) * 2 * std::numbers::pi;
  const double value[] = {std::sin(x), std::cos(x), -std::sin(x), -std::cos(x)};
  return value[static_cast<int>(quarter) & 3];
}
double cos_2pi(double u) { return sin_2pi(u < 0.75 ? u + 0.25 : u - 0.75); }

double exp_to_zero(double x) { return x < std::log(0x1p-126) ? 0 : std::exp(x); }
double erfcx(double x) {
  return static_cast<double>(std::exp(static_cast<long double>(x) * x) * std::erfc(static_cast<long double>(x)));
}

// Newton's method on the tail's side, where erfc keeps its digits.
double erf_inv_centered(double u) {
  const double tail = 2 * std::min(u, 1 - u);
  double y = 0;
  for (int i = 0; i < 60; ++i) {
    const double step = (std::erfc(y) - tail) * std::exp(y * y) * std::sqrt(std::numbers::pi) / 2;
    y += step;
    if (std::abs(step) < 1e-16 * y) break;
  }
  return u < 0.5 ? -y : y;
}

}  // namespace

TEST_CASE("math: errors stay within the stated ulps on every target") {
  const std::vector<float> turn = every_float(0.0f, 1.0f, 10007);
  check_ulps("sin", MathFunction::kSin2Pi, sin_2pi, turn, 2);
  check_ulps("cos", MathFunction::kCos2Pi, cos_2pi, turn, 2);
  check_ulps("sin beside its zero", MathFunction::kSin2Pi, sin_2pi, every_float(0.49f, 0.51f, 7), 2);
  check_ulps("cos beside its zero", MathFunction::kCos2Pi, cos_2pi, every_float(0.249f, 0.251f, 3), 2);
  check_ulps("exp", MathFunction::kExp, std::exp, every_float(0.0f, 88.0f, 10007), 2);
  check_ulps("exp", MathFunction::kExp, std::exp, every_float(-0.0f, -87.3f, 10007), 2);
  check_ulps("exp", MathFunction::kExp, exp_to_zero, every_float(-87.34f, -1e38f, 10007), 2);
  check_ulps("log", MathFunction::kLog, std::log, every_float(0x1p-126f, 3e38f, 20011), 2);
  check_ulps("log beside 1", MathFunction::kLog, std::log, every_float(0.9f, 1.1f, 17), 2);
  check_ulps("erfcx", MathFunction::kErfcx, erfcx, every_float(0.0f, 10.0f, 20011), 8);
  check_ulps("erfinv", MathFunction::kErfInvCentered, erf_inv_centered, every_float(0x1p-25f, 0x1.fffffep-1f, 5003), 5);
}

TEST_CASE("math: the ends of the domains") {
  test::for_each_target([&](const std::string& target) {
    CAPTURE(target);
    const float infinity = std::numeric_limits<float>::infinity();
    const std::vector<float> exp = apply(MathFunction::kExp, {0.0f, -infinity, -1e30f, -87.0f});
    CHECK(exp[0] == 1);
    CHECK(exp[1] == 0);
    CHECK(exp[2] == 0);
    CHECK(exp[3] > 0);
    CHECK(apply(MathFunction::kLog, {1.0f})[0] == 0);
    CHECK(apply(MathFunction::kErfInvCentered, {0.5f})[0] == 0);
    const std::vector<float> sin = apply(MathFunction::kSin2Pi, {0.0f, 0.25f, 0.5f, 0.75f});
    CHECK(sin == std::vector<float>{0, 1, 0, -1});
    const std::vector<float> cos = apply(MathFunction::kCos2Pi, {0.0f, 0.25f, 0.5f, 0.75f});
    CHECK(cos == std::vector<float>{1, 0, -1, 0});
  });
}

}  // namespace lanewise
#endif
