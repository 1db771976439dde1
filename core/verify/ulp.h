// Spacings of floats.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace lanewise::verify {

// 1 / the spacing of floats at x (2^-149 below the smallest normal float), without a division.
inline double floats_per_unit(double x) {
  const double smallest = std::numeric_limits<float>::min();
  const uint64_t exponent = std::bit_cast<uint64_t>(std::max(std::abs(x), smallest)) >> 52;
  return std::bit_cast<double>((2 * uint64_t{1023} + 23 - exponent) << 52);
}

inline double ulp(double x) { return 1 / floats_per_unit(x); }

// An ulp of a vector, as a share of its length: that of a float at 1.
constexpr double kVectorUlp = 0x1p-23;

}  // namespace lanewise::verify
