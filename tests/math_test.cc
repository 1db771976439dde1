#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "core/types.h"
#include "core/verify/function_study.h"
#include "core/verify/ulp.h"
#include "core/isa.h"
#include "kernels/functions.h"
#include "tests/kernel_harness.h"

namespace lanewise {
namespace {

std::vector<float> apply(Function f, std::vector<float> x) {
  const size_t n = x.size();
  x.resize(round_up_to_lanes(static_cast<uint32_t>(n)), x.back());
  apply_function(f, x.data(), x.data(), x.size());
  x.resize(n);
  return x;
}

}  // namespace

// The sampled form of what `lanewise verify --exhaustive` does with every float.
TEST_CASE("math: errors stay within the stated ulps on every target") {
  for (const verify::FunctionError& error : verify::study_functions(supported_isas(), 20011, 1)) {
    CAPTURE(error.function->name);
    CAPTURE(error.target);
    CAPTURE(error.worst_input);
    CHECK(error.max_error <= error.function->max_ulp);
    CHECK(error.max_error > 0.4);  // no float function is exact: the study does see errors
    CHECK(error.inputs > 10000);
  }
}

TEST_CASE("math: atan2 in turns within 3 ulp, also beside the axes, on every target") {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> turn(-0.5, 0.5), decades(-30, 0);
  constexpr uint32_t kCount = 1 << 14;
  std::vector<float> y(kCount), x(kCount), turns(kCount);
  for (uint32_t i = 0; i < kCount; ++i) {
    const double size = std::pow(10.0, decades(rng));
    // At any angle, or beside one of the axes or diagonals.
    const double angle =
        i % 2 ? turn(rng) : 0.125 * std::floor(8 * turn(rng)) + turn(rng) * std::pow(10.0, decades(rng));
    y[i] = static_cast<float>(size * std::sin(2 * std::numbers::pi * angle));
    x[i] = static_cast<float>(size * std::cos(2 * std::numbers::pi * angle));
  }
  test::for_each_target([&](const std::string& target) {
    CAPTURE(target);
    apply_atan2_turns(y.data(), x.data(), turns.data(), kCount);
    double worst = 0;
    for (uint32_t i = 0; i < kCount; ++i) {
      const double exact = std::atan2(double{y[i]}, double{x[i]}) / (2 * std::numbers::pi);
      worst = std::max(worst, std::abs(turns[i] - exact) * verify::floats_per_unit(exact));
    }
    CHECK(worst <= 3);
    CHECK(worst > 0.4);
    const std::vector<float> at_y = {0, 0, 1, -1, 0, -0.0f, 0, -0.0f, 1, -1, 0, 0, 0, 0, 0, 0};
    const std::vector<float> at_x = {1, 0, 0, 0, -1, -1, -0.0f, 0, -1, -1, 1, 1, 1, 1, 1, 1};
    std::vector<float> at(16);
    apply_atan2_turns(at_y.data(), at_x.data(), at.data(), 16);
    at.resize(10);
    CHECK(at == std::vector<float>{0, 0, 0.25f, -0.25f, 0.5f, -0.5f, 0, 0, 0.375f, -0.375f});
  });
}

TEST_CASE("math: the ends of the domains") {
  test::for_each_target([&](const std::string& target) {
    CAPTURE(target);
    const float infinity = std::numeric_limits<float>::infinity();
    const std::vector<float> exp = apply(Function::kExp, {0.0f, -infinity, -1e30f, -87.0f});
    CHECK(exp[0] == 1);
    CHECK(exp[1] == 0);
    CHECK(exp[2] == 0);
    CHECK(exp[3] > 0);
    CHECK(apply(Function::kLog, {1.0f})[0] == 0);
    CHECK(apply(Function::kErfInvCentered, {0.5f})[0] == 0);
    const std::vector<float> sin = apply(Function::kSin2Pi, {0.0f, 0.25f, 0.5f, 0.75f});
    CHECK(sin == std::vector<float>{0, 1, 0, -1});
    const std::vector<float> cos = apply(Function::kCos2Pi, {0.0f, 0.25f, 0.5f, 0.75f});
    CHECK(cos == std::vector<float>{1, 0, -1, 0});
  });
}

}  // namespace lanewise
