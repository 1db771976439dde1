#include "core/film.h"

#include <algorithm>
#include <cmath>

#include "core/workers.h"

namespace lanewise {

Image develop(const Film& film, uint32_t width, const Window& window, const Film* light, uint32_t threads) {
  Image image(window.width, window.height);
  for_each_row(threads, window.height, [&](uint32_t y) {
    for (uint32_t x = 0; x < window.width; ++x) {
      const size_t i = size_t{window.y + y} * width + window.x + x;
      if (film.samples[i] == 0) continue;
      double sum[3] = {};
      for (const Film* part : {&film, light}) {
        if (!part || part->samples[i] == 0) continue;
        const double scale = 1 / static_cast<double>(part->samples[i]);
        const PixelSums& sums = part->sums[i];
        sum[0] += sums.r.as<double>() * scale;
        sum[1] += sums.g.as<double>() * scale;
        sum[2] += sums.b.as<double>() * scale;
      }
      for (size_t c = 0; c < 3; ++c) image.pixel(x, y)[c] = static_cast<float>(sum[c]);
    }
  });
  return image;
}

ZeroedVector<uint64_t> sample_counts(const Film& film, uint32_t width, const Window& window) {
  ZeroedVector<uint64_t> counts;
  counts.reserve(size_t{window.width} * window.height);
  for (uint32_t y = window.y; y < window.y + window.height; ++y) {
    const auto row = film.samples.begin() + static_cast<ptrdiff_t>(size_t{y} * width + window.x);
    counts.insert(counts.end(), row, row + window.width);
  }
  return counts;
}

PixelMean pixel_mean(const PixelSums& sums, uint64_t samples) {
  if (samples == 0) return {};
  const double scale = 1 / static_cast<double>(samples);
  return {{static_cast<float>(sums.r.as<double>() * scale), static_cast<float>(sums.g.as<double>() * scale),
           static_cast<float>(sums.b.as<double>() * scale)},
          static_cast<float>(luminance_variance(sums, samples) * scale)};
}

PixelMean sum_of(const PixelMean& a, const PixelMean& b) {
  return {{a.rgb[0] + b.rgb[0], a.rgb[1] + b.rgb[1], a.rgb[2] + b.rgb[2]}, a.variance + b.variance};
}

MeanPicture mean_picture(const Film& film, uint32_t width, const Window& window, uint32_t side, uint32_t threads) {
  MeanPicture picture{window.width, window.height, {}, side, window.x % side, window.y % side};
  picture.pixels.resize(size_t{window.width} * window.height);
  for_each_row(threads, window.height, [&](uint32_t y) {
    for (uint32_t x = 0; x < window.width; ++x) {
      const size_t i = size_t{window.y + y} * width + window.x + x;
      picture.pixels[size_t{y} * window.width + x] = pixel_mean(film.sums[i], film.samples[i]);
    }
  });
  return picture;
}

double mean_luminance(const PixelSums& sums, uint64_t samples) {
  return sums.y.as<double>() / static_cast<double>(samples);
}

double luminance_variance(const PixelSums& sums, uint64_t samples) {
  if (samples < 2) return 0;
  // The sums are exact, so that all that cancels does so here, where there are the digits for it.
  const auto squares_around_mean = [&]<class T>(T) {
    const T y = sums.y.as<T>();
    return sums.y2.as<T>() - y * y / static_cast<T>(samples);
  };
  // Of the squares' sum: below, a long double has fewer digits left than a double.
  constexpr long double kCalm = 0x1p-12L;
  const long double quick = squares_around_mean(0.0L);
  const bool calm = quick < kCalm * sums.y2.as<long double>();
  const auto squares = static_cast<double>(calm ? squares_around_mean(__float128{}) : quick);
  return std::max(0.0, squares) / static_cast<double>(samples - 1);
}

bool has_converged(const PixelSums& sums, uint64_t samples, double tolerance) {
  const double error = std::sqrt(luminance_variance(sums, samples) / static_cast<double>(samples));
  return 1.96 * error <= tolerance * mean_luminance(sums, samples);
}

}  // namespace lanewise
