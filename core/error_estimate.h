// The error of a picture, from its own samples: MRSE as compare_images() would measure it against the true picture.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/film.h"

namespace lanewise {

class Probes;

// Mean of (x - truth)^2 / (truth + 0.01)^2 over pixels and channels. The true value lies in [low, high] with 95% probability,
// as far as can be said of distributions with tails as long as those of paths.
struct ErrorEstimate {
  double mrse = 0;
  double low = 0;
  double high = 0;
};

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

// From the expected square of every pixel's error by channel, or an estimate of it. Rows are shared out to threads.
using SquaredError = std::function<std::array<double, 3>(size_t pixel)>;
ErrorEstimate estimate_error(const MeanPicture& picture, const SquaredError& squares, uint32_t threads);

// From the variances in the picture alone, times the factor that the probes measure: samples that are not independent,
// as those of a low-discrepancy sequence, have less error than their variance says. light: what light paths add to it, with
// variances of its own, that no factor applies to; null if there are none.
ErrorEstimate estimate_error(const MeanPicture& picture, const MeanPicture* light, const Probes& probes,
                             uint32_t threads);

}  // namespace lanewise
