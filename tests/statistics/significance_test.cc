#include "tests/statistics/significance.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

TEST_SUITE_BEGIN("statistics");

namespace lanewise {
namespace {

TEST_CASE("significance: p-values of worked examples") {
  // 60 throws of a die: chi^2 = 19.2 at 5 degrees of freedom.
  const std::vector<double> throws = {20, 14, 8, 2, 8, 8}, fair(6, 10);
  CHECK(test::chi_square_p(throws, fair) == doctest::Approx(0.0017640));
  CHECK(test::chi_square_p(fair, fair) == 1);
  // The last two cells are pooled; a count in a cell without any density fails outright.
  CHECK(test::chi_square_p(std::vector<double>{10, 12, 3, 5}, std::vector<double>{11, 11, 4, 4}) ==
        doctest::Approx(std::exp(-1.0 / 11)));
  CHECK(test::chi_square_p(std::vector<double>{10, 10, 1}, std::vector<double>{10, 11, 0}) == 0);

  test::Moments a, b;
  for (const double x : {27.5, 21.0, 19.0, 23.6, 17.0, 17.9, 16.9, 20.1, 21.9, 22.6, 23.1, 19.6, 19.0, 21.7, 21.4})
    a.add(x);
  for (const double x : {27.1, 22.0, 20.8, 23.4, 23.4, 23.5, 25.8, 22.0, 24.8, 20.2, 21.9, 22.1, 22.9, 30.5, 31.3})
    b.add(x);
  CHECK(a.mean() == doctest::Approx(20.82));
  CHECK(b.variance() == doctest::Approx(10.83695));
  CHECK(test::welch_p(a, b) == doctest::Approx(0.00646041));
  CHECK(test::welch_p(a, b, 5) == 1);
  CHECK(test::t_test_p(a, 22) == doctest::Approx(0.1255273));
  CHECK(test::t_test_p(a, a.mean()) == 1);
  CHECK(test::sidak(0.01, 1) == doctest::Approx(0.01));
  CHECK(test::sidak(0.01, 100) == doctest::Approx(1.005e-4).epsilon(1e-3));
}

TEST_CASE("significance: p-values of claims that hold are uniform") {
  std::mt19937 rng(1);
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<size_t> cell(0, 19);
  constexpr int kRuns = 2000;
  std::vector<double> bins[3] = {std::vector<double>(10), std::vector<double>(10), std::vector<double>(10)};
  for (int run = 0; run < kRuns; ++run) {
    test::Moments a, b;
    for (int i = 0; i < 8; ++i) a.add(3 + normal(rng));
    for (int i = 0; i < 8; ++i) b.add(3 + 2 * normal(rng));
    std::vector<double> counts(20);
    for (int i = 0; i < 2000; ++i) counts[cell(rng)] += 1;
    const double p[] = {test::t_test_p(a, 3), test::welch_p(a, b),
                        test::chi_square_p(counts, std::vector<double>(20, 100))};
    for (int k = 0; k < 3; ++k) bins[k][std::min<size_t>(9, static_cast<size_t>(p[k] * 10))] += 1;
  }
  for (const std::vector<double>& of_test : bins) {
    CHECK(test::chi_square_p(of_test, std::vector<double>(10, kRuns / 10)) > 0.003);
  }
}

}  // namespace
}  // namespace lanewise

TEST_SUITE_END();
