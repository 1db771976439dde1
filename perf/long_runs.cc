// How far a sum of samples in floats would have come: build/long_runs SCENE
// Draws a million samples of every pixel of an 8 x 6 picture, one by one, and adds each to exact sums, to a sum in doubles and to
// one in floats; then goes on with the sum in floats alone, drawing from the same samples at random, to 2^30 in all. Prints a
// table for perf/results/long_runs.md.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <vector>

#include "core/wave.h"
#include "scenes/load.h"

namespace lanewise::perf {
namespace {

constexpr uint32_t kWidth = 8, kHeight = 6, kPixels = kWidth * kHeight;
constexpr uint64_t kDrawn = 1'000'000, kAll = uint64_t{1} << 30;

struct Pixel {
  std::vector<float> samples;
  float sum = 0;
  double in_doubles = 0;

  double mean() const {
    double all = 0;
    for (const float x : samples) all += x;
    return all / static_cast<double>(samples.size());
  }
  double deviation(double mean) const {
    double all = 0;
    for (const float x : samples) all += (x - mean) * (x - mean);
    return std::sqrt(all / static_cast<double>(samples.size()));
  }
};

// Over the pixels that are not black, of n samples.
void row(const std::vector<Pixel>& pixels, const std::vector<double>& truths, uint64_t n) {
  double off = 0, worst = 0, noise = 0;
  size_t lit = 0, above = 0, stopped = 0;
  for (size_t i = 0; i < pixels.size(); ++i) {
    const Pixel& p = pixels[i];
    const double truth = truths[i] / static_cast<double>(n);
    if (truth <= 0) continue;
    ++lit;
    const double error = std::abs(p.sum / static_cast<double>(n) - truth) / truth;
    const double own = p.deviation(p.mean()) / std::sqrt(static_cast<double>(n)) / truth;
    off += error * error;
    noise += own * own;
    worst = std::max(worst, error);
    above += error > own;
    // The mean sample is less than half of the sum's last place.
    const float next = std::nextafter(p.sum, INFINITY);
    stopped += truth < 0.5 * static_cast<double>(next - p.sum);
  }
  const auto count = static_cast<double>(lit);
  std::printf("| %llu | %.2g | %.2g | %.2g | %zu | %zu |\n", static_cast<unsigned long long>(n), std::sqrt(off / count),
              worst, std::sqrt(noise / count), above, stopped);
  std::fflush(stdout);
}

void study(const char* file) {
  Settings settings;
  settings.width = kWidth, settings.height = kHeight;
  const Plan plan = make_plan(load_scene(file), settings);
  Wave wave(plan, settings.wave);
  std::vector<uint32_t> all(kPixels);
  for (uint32_t i = 0; i < kPixels; ++i) all[i] = i;
  std::vector<Pixel> pixels(kPixels);
  std::vector<PixelSums> exact(kPixels), one(kPixels);
  std::vector<double> truths(kPixels);

  std::printf(
      "| samples | error of float sums, rms | most | noise, rms | pixels with more error than noise | that stand still "
      "|\n"
      "|---|---|---|---|---|---|\n");
  double drift = 0;  // of the exact means against those of doubles
  for (uint64_t n = 1; n <= kDrawn; ++n) {
    std::fill(one.begin(), one.end(), PixelSums());
    wave.run({.pixels = all.data(), .samples = 1, .first_sample = n - 1, .first_path = 0, .paths = kPixels},
             one.data());
    const bool shown = n == 1'000 || n == 10'000 || n == 100'000 || n == kDrawn;
    for (uint32_t i = 0; i < kPixels; ++i) {
      const auto x = one[i].g.as<float>();
      pixels[i].samples.push_back(x);
      pixels[i].sum += x;
      pixels[i].in_doubles += x;
      exact[i] += one[i];
      if (!shown) continue;
      truths[i] = exact[i].g.as<double>();
      if (truths[i] > 0) drift = std::max(drift, std::abs(pixels[i].in_doubles / truths[i] - 1));
    }
    if (shown) row(pixels, truths, n);
  }
  uint64_t random = 1;
  for (uint64_t n = kDrawn; n < kAll;) {
    const uint64_t next = std::bit_ceil(n + 1);
    for (uint32_t i = 0; i < kPixels; ++i) {
      Pixel& p = pixels[i];
      for (uint64_t k = n; k < next; ++k) {
        random = random * 6364136223846793005u + 1442695040888963407u;
        const float x = p.samples[((random >> 32) * kDrawn) >> 32];
        p.sum += x;
        truths[i] += x;
      }
    }
    n = next;
    row(pixels, truths, n);
  }
  std::printf("\nSums in doubles differ from the exact ones by at most %.1g of them.\n", drift);
}

}  // namespace
}  // namespace lanewise::perf

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "usage: long_runs SCENE\n");
    return 2;
  }
  lanewise::perf::study(argv[1]);
} catch (const std::exception& e) {
  std::fprintf(stderr, "long_runs: %s\n", e.what());
  return 1;
}
