// How far two pictures are apart.
#pragma once

#include <array>

#include "core/image.h"

namespace lanewise {

// Added to the true value that errors are taken relative to, so that black pixels do not count for all.
constexpr double kLeastRadiance = 0.01;

struct ImageComparison {
  std::array<double, 3> mean_a{};  // mean radiance of R, G, B
  std::array<double, 3> mean_b{};
  std::array<double, 3> relative_difference{};  // mean_a / mean_b - 1; 0 if both are 0, infinite if only mean_b is
  double mse = 0;                               // mean of (a - b)^2 over pixels and channels
  double mrse = 0;                              // mean of (a - b)^2 / (b + kLeastRadiance)^2: b is the reference
  double differing = 0;                         // share of the pixels that differ in any channel; NaN differs from all
};

// Throws Error, naming both sizes, unless they are the same.
void check_same_size(const Image& a, const Image& b);

// The pictures must be of one size (check_same_size) and not empty. NaN and Inf are not left out: they show up in the
// means.
ImageComparison compare_images(const Image& a, const Image& b);

}  // namespace lanewise
