// The colour spaces of FLIP, and how far two colours are apart in them. Section 4.1 of the HPG paper; the constants of
// sRGB and D65 are those of the authors' code.
#pragma once

#include <array>
#include <cmath>

namespace lanewise::flip {

using Colour = std::array<float, 3>;

// Of linear sRGB to X, Y and Z as shares of those of white: the rows sum to 1.
inline constexpr double kRelativeXyz[3][3] = {{10135552.0 / 23359437, 8788810.0 / 23359437, 4435075.0 / 23359437},
                                              {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                                              {1425312.0 / 80288307, 8788810.0 / 80288307, 70074185.0 / 80288307}};

constexpr std::array<std::array<double, 3>, 3> inverse(const double (&m)[3][3]) {
  std::array<std::array<double, 3>, 3> result{};
  const auto minor = [&m](size_t i, size_t j) {
    const size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    return m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1];
  };
  const double determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) result[i][j] = minor(j, i) / determinant;
  }
  return result;
}

template <class Matrix>
Colour multiply(const Matrix& m, const Colour& v) {
  Colour result;
  for (size_t i = 0; i < 3; ++i) {
    result[i] =
        static_cast<float>(m[i][0]) * v[0] + static_cast<float>(m[i][1]) * v[1] + static_cast<float>(m[i][2]) * v[2];
  }
  return result;
}

// L*a*b*-like: a lightness and two opponents, from what stands for X, Y and Z. Linear in them.
inline Colour opponents(const Colour& xyz) {
  return {116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])};
}

// YCxCz, in which the eye's contrast sensitivity filters.
inline Colour ycxcz(const Colour& rgb) { return opponents(multiply(kRelativeXyz, rgb)); }

inline Colour rgb_from_ycxcz(const Colour& c) {
  static constexpr auto kRgb = inverse(kRelativeXyz);
  const float y = (c[0] + 16) / 116;
  return multiply(kRgb, {y + c[1] / 500, y, y - c[2] / 200});
}

// CIE L*a*b*, its a* and b* by Hunt's effect: colours look less colourful in the dark.
inline Colour hunt_adjusted_lab(const Colour& rgb) {
  Colour t = multiply(kRelativeXyz, rgb);
  constexpr float kDelta = 6.0f / 29;
  for (float& v : t) v = v > kDelta * kDelta * kDelta ? std::cbrt(v) : v / (3 * kDelta * kDelta) + 4.0f / 29;
  const Colour lab = opponents(t);
  return {lab[0], 0.01f * lab[0] * lab[1], 0.01f * lab[0] * lab[2]};
}

// Abasi, Amani Tehran and Fairchild, Distance Metrics for Very Large Color Differences, 2020: city block in lightness,
// Euclidean in colour.
inline float hyab(const Colour& a, const Colour& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

}  // namespace lanewise::flip
