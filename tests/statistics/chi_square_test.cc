#include "tests/statistics/chi_square.h"

#include <doctest/doctest.h>

#include <random>

namespace lanewise {
namespace {

// Of uniform draws from the unit square, against a density that is `off` too large in one half of it and too small in the
// other.
double p_of_uniform(double off) {
  test::ChiSquare test({{0, 1}, {0, 1}, 8, 8, [off](double x, double) { return x < 0.5 ? 1 + off : 1 - off; }});
  std::mt19937 rng(1);
  for (int i = 0; i < 1 << 18; ++i) {
    const double x = std::generate_canonical<double, 32>(rng);
    test.add(x, std::generate_canonical<double, 32>(rng));
  }
  return test.p();
}

}  // namespace

TEST_CASE("chi-square: accepts the density that was drawn from, and finds one that is 2% off") {
  CHECK(p_of_uniform(0) > 0.01);
  CHECK(p_of_uniform(0.02) < 1e-4);
  CHECK(p_of_uniform(-0.02) < 1e-4);
}

}  // namespace lanewise
