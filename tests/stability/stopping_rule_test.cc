// Failure mode: a pixel that stops when its own samples look calm stops sooner when it happens to have missed its rare bright
// paths, and stays too dark; one that has not met any yet stops at once.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "core/film.h"
#include "core/noise_film.h"
#include "tests/stability/curve.h"

namespace lanewise {
namespace {

constexpr double kError = 0.2;  // relative standard error that both rules aim at
constexpr uint32_t kMaxSamples = 1 << 14;

// Half of the light comes steadily, the other half in spikes of probability p; the mean is 1.
class Spikes {
 public:
  explicit Spikes(double p) : p_(p) {}
  double operator()() { return 0.5 + (std::generate_canonical<double, 32>(rng_) < p_ ? 0.5 / p_ : 0); }

 private:
  double p_;
  std::minstd_rand rng_{42};
};

struct Measured {
  double bias;            // of the mean over pixels
  double standard_error;  // of that
};

template <class Pixels>
Measured measure(const Pixels& pixels) {
  double sum = 0, squares = 0;
  for (const double y : pixels) sum += y, squares += y * y;
  const double n = static_cast<double>(pixels.size()), mean = sum / n;
  return {mean - 1, std::sqrt((squares / n - mean * mean) / n)};
}

// -a 16 TOL: the same error, as a 95% interval.
Measured stop_on_own_samples(double p, size_t pixels) {
  Spikes draw(p);
  std::vector<double> means;
  for (size_t i = 0; i < pixels; ++i) {
    PixelSums sums;
    uint32_t n = 0;
    do {
      for (uint32_t k = 0; k < 16; ++k, ++n) {
        const double y = draw();
        sums.add(y, y, y);
      }
    } while (n < kMaxSamples && !has_converged(sums, n, 1.96 * kError));
    means.push_back(mean_luminance(sums, n));
  }
  return measure(means);
}

Measured stop_on_other_half(double p, uint32_t side) {
  Spikes draw(p);
  NoiseFilm film(side, side, {0, 0, side, side}, kError, kMaxSamples);
  while (film.count() > 0) {
    for (uint32_t half = 0; half < NoiseFilm::kHalves; ++half) {
      for (const uint32_t pixel : film.drawing(half)) {
        for (uint32_t k = 0; k < film.count(); ++k) {
          const double y = draw();
          film.sums(half)[pixel].add(y, y, y);
        }
      }
    }
    film.end_round();
  }
  const Image image = film.develop();
  std::vector<double> means;
  for (size_t i = 0; i < image.rgb.size(); i += 3) means.push_back(image.rgb[i]);
  return measure(means);
}

}  // namespace

TEST_SUITE_BEGIN("stability");

TEST_CASE("stability: stopping on the samples of the picture is biased low, on the other half's it is not") {
  test::Curve curve{.name = "stopping-rule",
                    .title = "A pixel that stops when its own samples look calm misses rare bright paths",
                    .naive = "stop on the picture's own samples (-a)",
                    .ours = "each half stops the other (--noise)",
                    .x_axis = "samples to a spike (1 / probability)",
                    .y_axis = "bias of the mean (relative)"};
#ifdef NDEBUG
  constexpr uint32_t kSide = 64;
#else
  constexpr uint32_t kSide = 16;
#endif
  double worst_z = 0;
  for (const double rarity : {4.0, 16.0, 64.0, 256.0, 1024.0, 4096.0}) {
    const Measured naive = stop_on_own_samples(1 / rarity, size_t{kSide} * kSide);
    const Measured ours = stop_on_other_half(1 / rarity, kSide);
    curve.points.push_back({rarity, std::abs(naive.bias), std::abs(ours.bias)});
    worst_z = std::max(worst_z, std::abs(ours.bias / ours.standard_error));
    CAPTURE(rarity);
    if (rarity > 4) CHECK(naive.bias < -0.1);
    if (rarity < 4096) CHECK(ours.standard_error < 3 * kError / kSide);  // beyond, some blocks end without a spike
  }
  CHECK(curve.worst_naive() > 0.4);
  CHECK(worst_z < 3.5);
  CHECK(curve.worst_ours() < (kSide == 64 ? 0.1 : 0.4));
  test::record(curve);
}

TEST_SUITE_END();

}  // namespace lanewise
