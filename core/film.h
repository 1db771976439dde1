// The film: every pixel's sums over its samples, and what can be said of them.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/image.h"
#include "core/settings.h"
#include "kernels/kernels.h"

namespace lanewise {

struct Film {
  std::vector<PixelSums> sums;
  std::vector<uint32_t> samples;  // behind each pixel's sums

  explicit Film(size_t pixels) : sums(pixels), samples(pixels) {}
};

// The mean of each pixel of the window, and how many samples it is of. width: of the whole picture.
Image develop(const Film& film, uint32_t width, const Window& window);
std::vector<uint32_t> sample_counts(const Film& film, uint32_t width, const Window& window);

// Whether a pixel's 95% confidence interval is within the tolerance: 1.96 sigma / sqrt(n) <= tolerance * mean, of
// luminance, with the sample variance (0 for n = 1).
bool has_converged(const PixelSums& sums, uint32_t samples, double tolerance);

}  // namespace lanewise
