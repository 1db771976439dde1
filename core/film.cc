#include "core/film.h"

#include <cmath>

namespace lanewise {

Image develop(const Film& film, uint32_t width, const Window& window) {
  Image image(window.width, window.height);
  for (uint32_t y = 0; y < window.height; ++y) {
    for (uint32_t x = 0; x < window.width; ++x) {
      const size_t i = size_t{window.y + y} * width + window.x + x;
      if (film.samples[i] == 0) continue;
      const double scale = 1.0 / film.samples[i];
      float* rgb = image.pixel(x, y);
      rgb[0] = static_cast<float>(film.sums[i].r * scale);
      rgb[1] = static_cast<float>(film.sums[i].g * scale);
      rgb[2] = static_cast<float>(film.sums[i].b * scale);
    }
  }
  return image;
}

std::vector<uint32_t> sample_counts(const Film& film, uint32_t width, const Window& window) {
  std::vector<uint32_t> counts;
  for (uint32_t y = window.y; y < window.y + window.height; ++y) {
    const auto row = film.samples.begin() + static_cast<ptrdiff_t>(size_t{y} * width + window.x);
    counts.insert(counts.end(), row, row + window.width);
  }
  return counts;
}

PixelMean pixel_mean(const PixelSums& sums, uint32_t samples) {
  const double scale = 1.0 / samples;
  return {{static_cast<float>(sums.r * scale), static_cast<float>(sums.g * scale), static_cast<float>(sums.b * scale)},
          static_cast<float>(luminance_variance(sums, samples) * scale)};
}

MeanPicture mean_picture(const Film& film, uint32_t width, const Window& window) {
  MeanPicture picture{window.width, window.height, {}};
  picture.pixels.reserve(size_t{window.width} * window.height);
  for (uint32_t y = 0; y < window.height; ++y) {
    for (uint32_t x = 0; x < window.width; ++x) {
      const size_t i = size_t{window.y + y} * width + window.x + x;
      picture.pixels.push_back(pixel_mean(film.sums[i], film.samples[i]));
    }
  }
  return picture;
}

double mean_luminance(const PixelSums& sums, uint32_t samples) { return luminance(sums.r, sums.g, sums.b) / samples; }

double luminance_variance(const PixelSums& sums, uint32_t samples) {
  if (samples < 2) return 0;
  const double n = samples;
  const double squares = sums.dy2 - sums.dy * sums.dy / n;
  return squares < 0 ? 0 : squares / (n - 1);  // a NaN stays one
}

bool has_converged(const PixelSums& sums, uint32_t samples, double tolerance) {
  const double error = std::sqrt(luminance_variance(sums, samples) / samples);
  return 1.96 * error <= tolerance * mean_luminance(sums, samples);
}

}  // namespace lanewise
