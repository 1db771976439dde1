// A Draw without a scene: each pixel's luminance has a distribution known exactly.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/schedule.h"

namespace lanewise::test {

struct MadeUpDraw {
  bool stratified = false;  // each 2^16 samples of a pixel are one sequence with low discrepancy, its shift random
  uint32_t firefly = ~0u;   // this pixel's sample 5 is very bright, at odds with its expectation
  std::function<void(size_t samples)> drew = [](size_t) {};

  static double uniform(uint64_t key) {
    key = (key ^ (key >> 30)) * 0xbf58476d1ce4e5b9u;  // splitmix64's finaliser (Steele, Lea & Flood, OOPSLA 2014)
    key = (key ^ (key >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((key ^ (key >> 31)) >> 11) * 0x1p-53;
  }

  // Smooth over the picture but for an edge every 16 pixels.
  static double expectation(uint32_t pixel) { return 0.2 + 0.1 * (pixel % 16); }

  // Skewed, with a variance of the square of its mean; mean 1.
  static double value(double u) { return -std::log1p(-u * (1 - 1e-9)); }

  uint64_t operator()(const std::vector<uint32_t>& pixels, uint64_t first, uint32_t count, PixelSums* sums,
                      uint32_t) const {
    for (const uint32_t pixel : pixels) {
      for (uint64_t sample = first; sample < first + count; ++sample) {
        double u = uniform((uint64_t{pixel} << 32) + (stratified ? sample >> 16 : sample) + 0x9E3779B97F4A7C15u);
        if (stratified) u = std::fmod(u + 0.6180339887498949 * (static_cast<double>(sample & 0xffff)), 1.0);
        const double y = pixel == firefly && sample == 5 ? 1e4 : expectation(pixel) * value(u);
        sums[pixel].add(y, y, y);
      }
    }
    drew(pixels.size() * count);
    return pixels.size() * count;
  }
};

}  // namespace lanewise::test
