#include "core/run_statistics.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

namespace lanewise {

TEST_CASE("run statistics: the middle and the scatter, whatever one outlier is") {
  CHECK(median({}) == 0);
  CHECK(median({3}) == 3);
  CHECK(median({4, 1, 3, 2}) == 2.5);
  CHECK(median({5, 1, 1e9}) == 5);
  CHECK(robust_deviation({1, 2, 3, 4, 1e9}) == doctest::Approx(1.4826));
  std::mt19937 rng(1);
  std::normal_distribution<double> normal(100, 7);
  std::vector<double> values;
  for (int i = 0; i < 10000; ++i) values.push_back(normal(rng));
  CHECK(robust_deviation(values) == doctest::Approx(7).epsilon(0.05));
}

// Tables of the two-sided test, e.g. Hollander & Wolfe, Nonparametric Statistical Methods, table A.6.
TEST_CASE("run statistics: the rank test is exact") {
  CHECK(rank_test({}, {1}) == 1);
  CHECK(rank_test({1}, {2}) == 1);
  CHECK(rank_test({1, 2, 3}, {4, 5, 6}) == doctest::Approx(2 / 20.0));
  CHECK(rank_test({1, 2, 3, 4, 5}, {6, 7, 8, 9, 10}) == doctest::Approx(2 / 252.0));
  CHECK(rank_test({6, 7, 8, 9, 10}, {1, 2, 3, 4, 5}) == doctest::Approx(2 / 252.0));
  CHECK(rank_test({1, 2, 3, 4, 6}, {5, 7, 8, 9, 10}) == doctest::Approx(4 / 252.0));
  CHECK(rank_test({1, 2, 3, 4}, {5, 6, 7, 8, 9, 10, 11}) == doctest::Approx(2 / 330.0));
  CHECK(rank_test({1, 4, 5, 8}, {2, 3, 6, 7}) == 1);
  CHECK(rank_test({2, 2, 2}, {2, 2, 2}) == 1);
  // Ranks 1.5, 1.5 and 3 against 4, 5 and 6.
  CHECK(rank_test({1, 1, 2}, {3, 4, 5}) == doctest::Approx(2 / 20.0));
}

TEST_CASE("run statistics: the rank test is wrong as seldom as it says, and finds what is there") {
  std::mt19937 rng(2);
  std::lognormal_distribution<double> noise(0, 0.02);
  const auto draw = [&](double factor) {
    std::vector<double> times;
    for (int i = 0; i < 8; ++i) times.push_back(factor * noise(rng));
    return times;
  };
  constexpr int kTrials = 1000;
  int false_alarms = 0, found = 0;
  for (int i = 0; i < kTrials; ++i) {
    false_alarms += rank_test(draw(1), draw(1)) < 0.05;
    found += rank_test(draw(1), draw(1.05)) < 0.05;
  }
  CHECK(false_alarms < 0.07 * kTrials);
  CHECK(false_alarms > 0.02 * kTrials);
  CHECK(found > 0.95 * kTrials);
}

}  // namespace lanewise
