#include "core/flip_filters.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lanewise::flip {
namespace {

using std::numbers::pi;

template <class F>
std::vector<double> sampled(int radius, const F& f) {
  std::vector<double> values;
  for (int x = -radius; x <= radius; ++x) values.push_back(f(static_cast<double>(x)));
  return values;
}

double sum(const std::vector<double>& values) {
  double total = 0;
  for (const double v : values) total += v;
  return total;
}

Weights scaled(const std::vector<double>& values, double scale) {
  Weights weights(values.size());
  std::ranges::transform(values, weights.begin(), [&](double v) { return static_cast<float>(scale * v); });
  return weights;
}

Weights normalized(const std::vector<double>& values) { return scaled(values, 1 / sum(values)); }

// Those above 0 scaled to sum to 1, those below to -1.
Weights balanced(std::vector<double> values) {
  double positive = 0, negative = 0;
  for (const double v : values) (v > 0 ? positive : negative) += std::abs(v);
  for (double& v : values) v /= v > 0 ? positive : negative;
  return scaled(values, 1);
}

}  // namespace

ContrastFilters contrast_filters(double pixels_per_degree) {
  // Table 1: a sqrt(pi / b) e^(-pi^2 x^2 / b), x in degrees.
  constexpr double kLightness = 0.0047, kRedGreen = 0.0053, kWide = 0.04, kWideShare = 34.1, kNarrow = 0.025,
                   kNarrowShare = 13.5;
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(kWide / (2 * pi * pi)) * pixels_per_degree));
  const auto gaussian = [&](double b, double factor) {
    return sampled(radius, [&](double x) {
      const double degrees = x / pixels_per_degree;
      return factor * std::exp(-pi * pi * degrees * degrees / b);
    });
  };
  // Along each axis the root of the factor in the plane.
  const auto root = [&](double share, double b) { return std::sqrt(share * std::sqrt(pi / b)); };
  const std::vector<double> narrow = gaussian(kNarrow, root(kNarrowShare, kNarrow));
  const std::vector<double> wide = gaussian(kWide, root(kWideShare, kWide));
  const double scale = 1 / std::hypot(sum(narrow), sum(wide));
  return {normalized(gaussian(kLightness, 1)), normalized(gaussian(kRedGreen, 1)), scaled(narrow, scale),
          scaled(wide, scale)};
}

FeatureFilters feature_filters(double pixels_per_degree) {
  const double deviation = 0.5 * 0.082 * pixels_per_degree;  // half the width from peak to trough, in degrees
  const int radius = static_cast<int>(std::ceil(3 * deviation));
  const auto gaussian = [&](double x) { return std::exp(-x * x / (2 * deviation * deviation)); };
  const auto second = [&](double x) { return (x * x / (deviation * deviation) - 1) * gaussian(x); };
  return {normalized(sampled(radius, gaussian)), balanced(sampled(radius, [&](double x) { return -x * gaussian(x); })),
          balanced(sampled(radius, second))};
}

void filter_row(const Weights& weights, const float* in, float* out, size_t n) {
  std::fill_n(out, n, 0.0f);
  for (size_t k = 0; k < weights.size(); ++k) {
    for (size_t i = 0; i < n; ++i) out[i] += weights[k] * in[i + k];
  }
}

void filter_column(const Weights& weights, const float* const* rows, float* out, size_t n) {
  std::fill_n(out, n, 0.0f);
  for (size_t k = 0; k < weights.size(); ++k) {
    for (size_t i = 0; i < n; ++i) out[i] += weights[k] * rows[k][i];
  }
}

}  // namespace lanewise::flip
