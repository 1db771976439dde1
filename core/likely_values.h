#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/film.h"

namespace lanewise {

// The true values that errors are taken relative to. A pixel's own mean will not do where it is noisy: the bright path that makes
// its error would hide it. So it is shrunk towards the mean of its neighbours, without itself, and that towards the mean of the
// blocks around, each the more the less their difference exceeds what the noise explains, by the weight max(0, 1 - variance /
// difference^2) of James & Stein (4th Berkeley Symposium, 1961).
class LikelyValues {
 public:
  // The picture must outlast it. Rows of blocks are shared out to threads.
  LikelyValues(const MeanPicture& picture, uint32_t threads);

  // At (x, y), of a pixel whose samples have the mean `centre`: the picture's own there, or another estimate of it.
  std::array<double, 3> operator()(uint32_t x, uint32_t y, const PixelMean& centre) const;

  static size_t bytes_per_pixel();  // that it takes while it is made

 private:
  // Sums over some pixels.
  struct Group {
    std::array<double, 3> sum{};
    double variance = 0, pixels = 0;

    void add(const PixelMean& pixel) {
      for (size_t c = 0; c < 3; ++c) sum[c] += pixel.rgb[c];
      variance += pixel.variance, pixels += 1;
    }
    void add(const Group& other) {
      for (size_t c = 0; c < 3; ++c) sum[c] += other.sum[c];
      variance += other.variance, pixels += other.pixels;
    }
    // Some of them. What rounding has left is not below zero.
    void take(const Group& other) {
      for (size_t c = 0; c < 3; ++c) sum[c] = std::max(0.0, sum[c] - other.sum[c]);
      variance = std::max(0.0, variance - other.variance), pixels -= other.pixels;
    }
    std::array<double, 3> mean() const { return {sum[0] / pixels, sum[1] / pixels, sum[2] / pixels}; }
    double mean_variance() const { return variance / pixels; }
  };
  static constexpr uint32_t kBlock = 4;  // pixels a side

  const MeanPicture& picture_;
  uint32_t columns_, rows_;    // of blocks
  std::vector<Group> around_;  // of each block and the up to eight around it
};

}  // namespace lanewise
