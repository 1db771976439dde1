#include <doctest/doctest.h>

#include <limits>
#include <vector>

#include "core/types.h"
#include "core/verify/function_study.h"
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
