#include "kernels/reference/roulette.h"

#include <doctest/doctest.h>

#include "tests/kernel_harness.h"

namespace lanewise {

TEST_CASE("roulette: SIMD against its twin") {
  const Plan plan = test::test_plan();
  const Step step = {.bounce = kRouletteBounce};
  test::check_kernel(plan, "roulette", step);
  test::check_kernel(plan, "roulette", step, [](std::mt19937& rng, Path<float>& p) {
    const float scale = rng() % 2 ? 0.0f : 1e-20f;
    p.beta_r *= scale, p.beta_g *= scale, p.beta_b *= scale;
  });
}

TEST_CASE("roulette: none before its first bounce") {
  static constexpr KernelBounds kNone = {};
  verify::KernelCase none = {"roulette", roulette, [](const Plan&, Path<double>&) {},
                             kNone,      "",       verify::kernel_case("roulette").fill};
  test::check_kernel(test::test_plan(), none, {.bounce = kRouletteBounce - 1});
}

TEST_CASE("roulette: the expected throughput is the throughput") {
  const Plan plan = test::test_plan();
  for (const double beta : {0.02, 0.3, 1.0, 2.0}) {
    double sum = 0;
    constexpr int kPaths = 200000;
    for (int i = 0; i < kPaths; ++i) {
      Path<double> p;
      p.pixel = 5;
      p.sample = static_cast<uint32_t>(i);
      p.step.bounce = kRouletteBounce;
      p.beta_r = beta, p.beta_g = 0.5 * beta, p.beta_b = 0;
      reference::roulette(plan, p);
      sum += p.beta_r;
    }
    const double q = std::min(1.0, beta);
    const double sigma = beta * std::sqrt((1 - q) / q / kPaths);
    CHECK(sum / kPaths == doctest::Approx(beta).epsilon(4 * sigma / beta + 1e-12));
  }
}

}  // namespace lanewise
