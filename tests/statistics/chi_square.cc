#include "tests/statistics/chi_square.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numeric>

namespace lanewise::test {
namespace {

using Gauss = boost::math::quadrature::gauss<double, 7>;
constexpr uint32_t kLookedAt = 2048;

// Cell boundaries: a + (b - a) i / n, exactly b at the end.
Interval cell(const Interval& all, uint32_t i, uint32_t n) {
  const double step = (all.hi - all.lo) / n;
  return {all.lo + step * i, i + 1 == n ? all.hi : all.lo + step * (i + 1)};
}

bool covers(const Interval& all, const Interval& part) { return all.lo <= part.lo && all.hi >= part.hi; }

bool contains(const Interval& all, double x) { return x >= all.lo && x <= all.hi; }

uint32_t index_of(const Interval& all, double x, uint32_t n) {
  return std::min(n - 1, static_cast<uint32_t>((x - all.lo) / (all.hi - all.lo) * n));
}

double integrate_cell(const Domain& domain, const Interval& x, const Interval& y) {
  const auto along_x = [&](double at_y) {
    const Interval lit = domain.support ? domain.support(at_y) : x;
    const double lo = std::max(x.lo, lit.lo), hi = std::min(x.hi, lit.hi);
    return lo < hi ? Gauss::integrate([&](double at_x) { return domain.density(at_x, at_y); }, lo, hi) : 0.0;
  };
  // Where the support ends within the cell, the integral over x has kinks and roots in y.
  const bool whole = !domain.support || (covers(domain.support(y.lo), x) && covers(domain.support(y.hi), x));
  const uint32_t strips = whole ? 1 : 32;
  double sum = 0;
  for (uint32_t k = 0; k < strips; ++k) {
    const Interval strip = cell(y, k, strips);
    sum += Gauss::integrate(along_x, strip.lo, strip.hi);
  }
  return sum;
}

}  // namespace

std::vector<double> integrate_cells(const Domain& domain) {
  std::vector<double> cells;
  for (uint32_t row = 0; row < domain.rows; ++row) {
    for (uint32_t column = 0; column < domain.columns; ++column) {
      cells.push_back(integrate_cell(domain, cell(domain.x, column, domain.columns), cell(domain.y, row, domain.rows)));
    }
  }
  return cells;
}

double integrate(const Domain& domain) {
  const std::vector<double> cells = integrate_cells(domain);
  return std::accumulate(cells.begin(), cells.end(), 0.0);
}

ChiSquare::ChiSquare(const Domain& domain)
    : domain_(domain),
      shares_(integrate_cells(domain)),
      counts_(shares_.size()),
      integral_(std::accumulate(shares_.begin(), shares_.end(), 0.0)) {}

void ChiSquare::add(double x, double y) {
  if (!contains(domain_.x, x) || !contains(domain_.y, y) || (draws_ < kLookedAt && !(domain_.density(x, y) > 0))) {
    ++impossible_;
    return;
  }
  ++draws_;
  counts_[size_t{index_of(domain_.y, y, domain_.rows)} * domain_.columns + index_of(domain_.x, x, domain_.columns)] +=
      1;
}

double ChiSquare::p() const {
  const bool negative = std::any_of(shares_.begin(), shares_.end(), [](double share) { return !(share >= 0); });
  if (impossible_ > 0 || negative || !(integral_ <= 1 + kExcess)) return 0;
  const double draws = double(draws_) + void_;
  std::vector<double> counts = counts_, expected;
  for (const double share : shares_) expected.push_back(share * draws);
  counts.push_back(void_);
  expected.push_back(std::max(1 - integral_, 0.0) * draws);
  return chi_square_p(counts, expected);
}

}  // namespace lanewise::test
