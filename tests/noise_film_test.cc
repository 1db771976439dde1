#include "core/noise_film.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

namespace lanewise {
namespace {

// Draws every round of the film, sample by sample: value(half, pixel) is a luminance.
template <class F>
void draw_all(NoiseFilm& film, const F& value) {
  while (film.count() > 0) {
    for (uint32_t half = 0; half < NoiseFilm::kHalves; ++half) {
      for (const uint32_t pixel : film.drawing(half)) {
        for (uint32_t i = 0; i < film.count(); ++i) {
          const double y = value(half, pixel);
          film.sums(half)[pixel].add(y, y, y);
        }
      }
    }
    film.end_round();
  }
}

}  // namespace

TEST_CASE("noise film: calm pixels end at once, noisy ones where their error is small enough") {
  NoiseFilm film(64, 32, {0, 0, 64, 32}, 0.05, 1 << 16);
  std::mt19937 rng(1);
  std::exponential_distribution<double> noisy(1.0);  // sigma = mean = 1: 20^2 samples / 1.01^2
  draw_all(film, [&](uint32_t, uint32_t pixel) { return pixel % 64 < 32 ? 1.0 : noisy(rng); });
  const ZeroedVector<uint64_t> counts = film.sample_counts();
  CHECK(counts[0] == 2 * NoiseFilm::kFirstSamples);
  CHECK(counts[63] > 350);
  CHECK(counts[63] < 650);
  CHECK(counts[31] == counts[63]);  // beside a noisy block
  CHECK(film.converged() == 1);
  CHECK(film.drawn() == film.expected());
  const Image image = film.develop();
  double square = 0;
  for (uint32_t y = 0; y < 32; ++y) {
    for (uint32_t x = 32; x < 64; ++x) square += std::pow(image.pixel(x, y)[0] - 1.0, 2) / (32 * 32);
  }
  CHECK(std::sqrt(square) < 0.05);
  CHECK(std::sqrt(square) > 0.03);
}

TEST_CASE("noise film: what never calms down has not converged, and ends at the most samples") {
  NoiseFilm film(40, 8, {0, 0, 40, 8}, 0.5, 101);
  int drawn[2] = {0, 0};  // of the pixel whose every half has one bright sample, the first
  draw_all(film, [&](uint32_t half, uint32_t pixel) { return pixel != 3 ? 1.0 : drawn[half]++ == 0 ? 1e6 : 0.0; });
  const ZeroedVector<uint64_t> counts = film.sample_counts();
  CHECK(counts[3] == 100);
  CHECK(counts[15] == 100);  // the block beside it
  CHECK(counts[16] == 2 * NoiseFilm::kFirstSamples);
  CHECK(film.converged() == doctest::Approx(4.0 / 5));
}

TEST_CASE("noise film: an estimate has as many samples as the other half's values say, not its own") {
  // The first half is calm and the second noisy: so the first half draws on, for it is the second that speaks.
  std::mt19937 rng(3);
  std::exponential_distribution<double> noisy(1.0);
  NoiseFilm film(8, 8, {0, 0, 8, 8}, 0.05, 1 << 16);
  uint32_t drawn[2] = {0, 0};
  double sum = 0, at_end = 0;
  draw_all(film, [&](uint32_t half, uint32_t pixel) {
    if (pixel == 0) ++drawn[half];
    const double y = half == 0 ? 1.0 : noisy(rng);
    if (half == 1 && pixel == 0 && drawn[1] <= NoiseFilm::kFirstSamples) sum += y;
    return y;
  });
  CHECK(drawn[0] > 150);
  CHECK(drawn[0] == drawn[1]);
  at_end = 0.5 * (1.0 + sum / NoiseFilm::kFirstSamples);  // the second half's estimate ended with the first round
  CHECK(film.develop().rgb[0] == doctest::Approx(at_end));
}

TEST_CASE("noise film: a window's pixels are drawn, with a block around them") {
  NoiseFilm film(100, 50, {30, 20, 10, 5}, 0.1, 64);
  // Columns 24 to 39 hold the window, rows 16 to 31; a block more on each side.
  CHECK(film.drawing(0).size() == 32 * 32);
  CHECK(film.drawing(0).front() == 8 * 100 + 16);
  draw_all(film, [](uint32_t, uint32_t pixel) { return 1.0 + pixel; });
  const Image image = film.develop();
  CHECK(image.width == 10);
  CHECK(image.height == 5);
  CHECK(image.pixel(9, 4)[1] == 1.0f + 24 * 100 + 39);
  CHECK(film.sample_counts().size() == 50);
}

}  // namespace lanewise
