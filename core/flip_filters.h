// The filters of FLIP, each a product of one along x and one along y.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace lanewise::flip {

// Weights at -radius .. radius.
using Weights = std::vector<float>;

// What the eye resolves (HPG paper, section 4.1.1): Gaussians, normalised over the plane. That of the blue-yellow
// opponent is the sum of two.
struct ContrastFilters {
  Weights lightness, red_green, blue_yellow_narrow, blue_yellow_wide;
};
ContrastFilters contrast_filters(double pixels_per_degree);

// What it notices (section 4.2): edges by the first derivative of a Gaussian, points by the second, along one axis, and
// the Gaussian along the other. Positive and negative weights of the derivatives sum to 1 and -1.
struct FeatureFilters {
  Weights gaussian, edge, point;
};
FeatureFilters feature_filters(double pixels_per_degree);

// out[i] = sum over k of weights[k] in[i + k], for i < n.
void filter_row(const Weights& weights, const float* in, float* out, size_t n);

// out[i] = sum over k of weights[k] rows[k][i], for i < n.
void filter_column(const Weights& weights, const float* const* rows, float* out, size_t n);

}  // namespace lanewise::flip
