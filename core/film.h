// The film: every pixel's sums over its samples, and what can be said of them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/image.h"
#include "core/settings.h"
#include "core/zeroed_pages.h"
#include "kernels/kernels.h"

namespace lanewise {

struct Film {
  ZeroedVector<PixelSums> sums;    // {} at first
  ZeroedVector<uint64_t> samples;  // behind each pixel's sums; 0: they are not looked at

  explicit Film(size_t pixels) : sums(pixels), samples(pixels) {}
};

// The mean of each pixel of the window, and how many samples it is of. width: of the whole picture. light: what light paths add,
// of so many passes; null if there are none. Rows are shared out to threads.
Image develop(const Film& film, uint32_t width, const Window& window, const Film* light, uint32_t threads);
ZeroedVector<uint64_t> sample_counts(const Film& film, uint32_t width, const Window& window);

// The mean of a pixel's samples, and the variance of the mean's luminance, were they independent.
struct PixelMean {
  std::array<float, 3> rgb{};
  float variance = 0;
};

struct MeanPicture {
  uint32_t width = 0, height = 0;
  std::vector<PixelMean> pixels;
  // Pixels that are not independent of each other: those in a square of `side` whose first column and row are before (x, y) = (0, 0)
  // by these, modulo side.
  uint32_t side = 1, column = 0, row = 0;

  // The number of the square, of its column or row, that x or y lies in.
  uint32_t square_column(uint32_t x) const { return (x + column) / side; }
  uint32_t square_row(uint32_t y) const { return (y + row) / side; }
};

// Of two independent parts of a pixel's radiance.
PixelMean sum_of(const PixelMean& a, const PixelMean& b);

PixelMean pixel_mean(const PixelSums& sums, uint64_t samples);  // of none: black
// side: of the squares of the whole picture whose pixels are not independent. Rows are shared out to threads.
MeanPicture mean_picture(const Film& film, uint32_t width, const Window& window, uint32_t side, uint32_t threads);

// Of a pixel's luminance: the mean of its samples, and their variance sigma^2 (unbiased; 0 for one sample). samples > 0.
double mean_luminance(const PixelSums& sums, uint64_t samples);
double luminance_variance(const PixelSums& sums, uint64_t samples);

// The rule of -a: whether a pixel's 95% confidence interval is within the tolerance, 1.96 sigma / sqrt(n) <= tolerance * mean.
// It looks at the samples that the picture is made of, so it stops sooner where they happen to be dark: biased low, on
// skewed pixels by far more than the tolerance (perf/results/adaptive_bias.md). A NaN never converges.
bool has_converged(const PixelSums& sums, uint64_t samples, double tolerance);

}  // namespace lanewise
