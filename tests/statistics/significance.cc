#include "tests/statistics/significance.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace lanewise::test {
namespace {

// Two-sided; t of infinite size has p = 0.
double student_p(double t, double degrees) {
  if (!std::isfinite(t)) return 0;
  return 2 * boost::math::cdf(boost::math::complement(boost::math::students_t(degrees), std::abs(t)));
}

double beyond(double difference, double slack) { return std::max(std::abs(difference) - slack, 0.0); }

}  // namespace

double chi_square_p(std::span<const double> counts, std::span<const double> expected) {
  double statistic = 0, pooled_count = 0, pooled_expected = 0;
  int cells = 0;
  const auto add = [&](double count, double mean) {
    statistic += (count - mean) * (count - mean) / mean;
    ++cells;
  };
  for (size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] > 0 && !(expected[i] > 0)) return 0;
    if (expected[i] >= 5) {
      add(counts[i], expected[i]);
    } else {
      pooled_count += counts[i];
      pooled_expected += expected[i];
    }
  }
  // A pool that expects less than 5 is too small to judge, unless it holds far more than it should.
  if (pooled_expected >= 5 || pooled_count > 5 + 5 * pooled_expected) add(pooled_count, pooled_expected);
  if (cells < 2 || !std::isfinite(statistic)) return std::isfinite(statistic) ? 1 : 0;
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(cells - 1), statistic));
}

double t_test_p(const Moments& sample, double mean, double slack) {
  const double difference = beyond(sample.mean() - mean, slack);
  if (difference == 0) return 1;
  return student_p(difference / std::sqrt(sample.mean_variance()), double(sample.count() - 1));
}

double welch_p(const Moments& a, const Moments& b, double slack) {
  const double difference = beyond(a.mean() - b.mean(), slack);
  if (difference == 0) return 1;
  const double va = a.mean_variance(), vb = b.mean_variance();
  if (!(va + vb > 0)) return 0;
  // Welch & Satterthwaite.
  const double degrees = (va + vb) * (va + vb) / (va * va / double(a.count() - 1) + vb * vb / double(b.count() - 1));
  return student_p(difference / std::sqrt(va + vb), degrees);
}

double sidak(double significance, size_t tests) {
  return -std::expm1(std::log1p(-significance) / double(std::max<size_t>(tests, 1)));
}

void Family::add(const std::string& claim, double p) {
  if (std::isnan(p)) p = 0;
  ++tests_;
  if (p < least_ || tests_ == 1) {
    least_ = p;
    claim_ = claim;
  }
}

std::string Family::least_likely() const {
  return claim_ + ": p = " + std::to_string(least_) + ", " + std::to_string(tests_) + " tests at " +
         std::to_string(sidak(0.01, tests_));
}

}  // namespace lanewise::test
