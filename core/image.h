// A picture in memory: linear RGB radiance, float, rows from the top.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/zeroed_pages.h"

namespace lanewise {

// What is rendered and read.
constexpr uint64_t kMostPixels = uint64_t{1} << 28;

struct Image {
  uint32_t width = 0;
  uint32_t height = 0;
  ZeroedVector<float> rgb;  // 3 * width * height, interleaved

  Image() = default;
  Image(uint32_t w, uint32_t h) : width(w), height(h), rgb(size_t{3} * w * h) {}
  const float* pixel(uint32_t x, uint32_t y) const { return &rgb[3 * (size_t{y} * width + x)]; }
  float* pixel(uint32_t x, uint32_t y) { return &rgb[3 * (size_t{y} * width + x)]; }
};

}  // namespace lanewise
