#include "core/film.h"

#include <algorithm>

namespace lanewise {

Image develop(const Film& film, uint32_t width, uint32_t height) {
  Image image(width, height);
  for (size_t i = 0; i < film.sums.size(); ++i) {
    if (film.samples[i] == 0) continue;
    const double scale = 1.0 / film.samples[i];
    image.rgb[3 * i] = static_cast<float>(film.sums[i].r * scale);
    image.rgb[3 * i + 1] = static_cast<float>(film.sums[i].g * scale);
    image.rgb[3 * i + 2] = static_cast<float>(film.sums[i].b * scale);
  }
  return image;
}

bool has_converged(const PixelSums& sums, uint32_t samples, double tolerance) {
  const double n = samples;
  const double mean = luminance(sums.r, sums.g, sums.b) / n;
  const double variance = samples > 1 ? std::max(0.0, sums.y2 - n * mean * mean) / (n - 1) : 0.0;
  return 1.96 * std::sqrt(variance / n) <= tolerance * mean;
}

}  // namespace lanewise
