// A pixel's sums over its samples, exact, so that they are the same whatever the order and the grouping of the samples: on any
// number of threads, on many machines, merged from files.
//
// A sum of floats is rounded at every step, by how much hangs on what was added before. These are whole numbers of 2^-72 (of
// 2^-56 for squares) in 128 bits instead: a sample is rounded once, by itself, to the nearest, and the rest is integer arithmetic.
// What that costs in accuracy: nothing for samples of 2^-49 (1.8e-15) and more, whose last bit is a multiple of 2^-72; 2^-73 for
// darker ones. Squares of luminance are exact from a luminance of 2^-5 on, and 2^-57 off below. Sums end at 2^56 (7.2e16), squares
// at 2^72 (4.7e21): what would be more is that, whatever the order still.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

namespace lanewise {

// Rec. 709 luminance of linear RGB.
constexpr double luminance(double r, double g, double b) { return 0.2126 * r + 0.7152 * g + 0.0722 * b; }
template <class T>
constexpr double luminance(const std::array<T, 3>& rgb) {
  return luminance(rgb[0], rgb[1], rgb[2]);
}

using Uint128 = unsigned __int128;

// A sum of numbers >= 0 in units of 2^-kPlaces.
template <int kPlaces>
class ExactSum {
 public:
  static constexpr int places = kPlaces;

  constexpr ExactSum() = default;
  explicit constexpr ExactSum(Uint128 units) : units_(units) {}

  void add(double x) {
    const auto bits = std::bit_cast<uint64_t>(x);
    const uint64_t digits = (bits & 0xfffffffffffffu) | uint64_t{1} << 52;
    const int shift = static_cast<int>(bits >> 52) - 1075 + kPlaces;
    if (shift >= 128 - 53) {
      const double units = std::ldexp(x, kPlaces);
      *this += ExactSum(units < 0x1p128 ? static_cast<Uint128>(units) : ~Uint128{0});
    } else if (shift >= 0) {
      *this += ExactSum(Uint128{digits} << shift);
    } else if (shift >= -54) {  // its last digits are below the units': to the nearest, to the even one of two
      const uint64_t whole = digits >> -shift, rest = digits & ((uint64_t{1} << -shift) - 1);
      const uint64_t half = uint64_t{1} << (-shift - 1);
      *this += ExactSum(Uint128{whole} + (rest > half || (rest == half && whole % 2 == 1)));
    }
  }
  ExactSum& operator+=(ExactSum other) {
    units_ += other.units_;
    if (units_ < other.units_) units_ = ~Uint128{0};
    return *this;
  }
  // To the nearest T.
  template <class T>
  T as() const {
    if constexpr (std::is_same_v<T, double>) {
      constexpr double kUnit = 1 / static_cast<double>(Uint128{1} << kPlaces);
      const auto high = static_cast<uint64_t>(units_ >> 64), low = static_cast<uint64_t>(units_);
      if (high == 0 && low >> 63 == 0) return static_cast<double>(static_cast<int64_t>(low)) * kUnit;
      // The first 63 digits, which processors convert by themselves; the last of them tells whether anything is below.
      const int zeros = high == 0 ? 64 : std::countl_zero(high);
      const uint64_t first = zeros == 0 ? high : zeros == 64 ? low : high << zeros | low >> (64 - zeros);
      const bool rest = first % 2 != 0 || (zeros < 64 && low << zeros != 0);
      const double unit = std::bit_cast<double>(static_cast<uint64_t>(1023 + 65 - zeros - kPlaces) << 52);
      return static_cast<double>(static_cast<int64_t>(first >> 1 | uint64_t{rest})) * unit;
    } else {
      return static_cast<T>(units_) * static_cast<T>(1 / static_cast<double>(Uint128{1} << kPlaces));
    }
  }
  Uint128 units() const { return units_; }
  bool operator==(const ExactSum&) const = default;

 private:
  Uint128 units_ = 0;
};

struct PixelSums {
  ExactSum<72> r, g, b;
  ExactSum<72> y;   // luminance, each sample's rounded to a float so that its square is exact
  ExactSum<56> y2;  // its square

  // A sample, as floats: finite and >= 0.
  void add(double red, double green, double blue) {
    const auto r_f = static_cast<float>(red), g_f = static_cast<float>(green), b_f = static_cast<float>(blue);
    const double y_f = static_cast<float>(luminance(r_f, g_f, b_f));
    r.add(r_f);
    g.add(g_f);
    b.add(b_f);
    y.add(y_f);
    y2.add(y_f * y_f);
  }
  PixelSums& operator+=(const PixelSums& other) {
    r += other.r;
    g += other.g;
    b += other.b;
    y += other.y;
    y2 += other.y2;
    return *this;
  }
  bool operator==(const PixelSums&) const = default;
};

}  // namespace lanewise
