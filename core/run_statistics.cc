#include "core/run_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace lanewise {
namespace {

// Twice the rank of each value among all of them, from 2 on: whole numbers, also where equal values share their mean rank.
std::vector<size_t> doubled_ranks(const std::vector<double>& values) {
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  std::vector<size_t> ranks;
  for (const double value : values) {
    const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), value);
    ranks.push_back(static_cast<size_t>((first - sorted.begin()) + (last - sorted.begin())) + 1);
  }
  return ranks;
}

}  // namespace

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  return (values[(n - 1) / 2] + values[n / 2]) / 2;
}

double robust_deviation(const std::vector<double>& values) {
  const double middle = median(values);
  std::vector<double> distances;
  for (const double value : values) distances.push_back(std::fabs(value - middle));
  return 1.4826 * median(distances);
}

double rank_test(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.empty() || b.empty()) return 1;
  std::vector<double> all = a;
  all.insert(all.end(), b.begin(), b.end());
  const std::vector<size_t> ranks = doubled_ranks(all);

  // ways[k][s]: choices of k of the ranks whose sum is s.
  size_t sum = 0;
  for (const size_t rank : ranks) sum += rank;
  std::vector<std::vector<double>> ways(a.size() + 1, std::vector<double>(sum + 1));
  ways[0][0] = 1;
  for (const size_t rank : ranks) {
    for (size_t k = a.size(); k > 0; --k) {
      for (size_t s = rank; s <= sum; ++s) ways[k][s] += ways[k - 1][s - rank];
    }
  }

  size_t sum_a = 0;
  for (size_t i = 0; i < a.size(); ++i) sum_a += ranks[i];
  // Distances from the expected sum, times the number of values.
  const auto distance = [&](size_t s) {
    return std::abs(static_cast<int64_t>(s * all.size()) - static_cast<int64_t>(sum * a.size()));
  };
  double as_far = 0, any = 0;
  for (size_t s = 0; s <= sum; ++s) {
    any += ways[a.size()][s];
    if (distance(s) >= distance(sum_a)) as_far += ways[a.size()][s];
  }
  return as_far / any;
}

}  // namespace lanewise
