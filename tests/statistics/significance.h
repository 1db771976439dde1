// Tests of significance. A p-value is the chance of data at least this far from what is claimed, if the claim holds:
// uniform in [0, 1] for claims that hold, near 0 for those that do not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace lanewise::test {

// Count, mean and variance of numbers that come one at a time (Welford 1962).
class Moments {
 public:
  void add(double x) {
    ++count_;
    const double d = x - mean_;
    mean_ += d / double(count_);
    squares_ += d * (x - mean_);
  }
  uint64_t count() const { return count_; }
  double mean() const { return mean_; }
  double variance() const { return count_ > 1 ? squares_ / double(count_ - 1) : 0; }  // of one number
  double mean_variance() const { return variance() / double(count_); }

 private:
  uint64_t count_ = 0;
  double mean_ = 0, squares_ = 0;
};

// Pearson's test of counts against what each cell expects; both must have the same sum. Cells that expect fewer than 5
// are pooled, as in Mitsuba 3's chi2.py. 0 if something fell where nothing is expected.
double chi_square_p(std::span<const double> counts, std::span<const double> expected);

// Student's two-sided test that the mean is `mean`. Up to `slack` of difference is no difference (rounding, say).
double t_test_p(const Moments& sample, double mean, double slack = 0);

// Welch's two-sided test that two samples have the same mean.
double welch_p(const Moments& a, const Moments& b, double slack = 0);

// Sidak's level: if `tests` independent claims hold, the chance that any has a p-value below it is `significance`.
double sidak(double significance, size_t tests);

// Claims that are judged together: at a significance of 0.01 for all of them.
class Family {
 public:
  void add(const std::string& claim, double p);  // a p that is NaN counts as 0
  bool holds() const { return least_ >= sidak(0.01, tests_); }
  size_t tests() const { return tests_; }
  std::string least_likely() const;  // for messages: the claim with the smallest p

 private:
  size_t tests_ = 0;
  double least_ = 1;
  std::string claim_;
};

}  // namespace lanewise::test
