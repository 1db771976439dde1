// What is seen of the rows of a displayed picture, for FLIP.
#pragma once

#include <cstdint>
#include <vector>

#include "core/flip_colour.h"
#include "core/flip_filters.h"
#include "core/image.h"

namespace lanewise::flip {

// Radiance of a channel, finite and at least 0, to what a display shows of it, in [0, 1].
struct Display {
  bool tone_mapped = false;
  double gain = 1;  // used only for tone mapping

  float operator()(float radiance) const;
};

// Narkowicz's fit of the ACES tone curve, (k0 x^2 + k1 x) / (k2 x^2 + k3 x + k4), at his exposure of 0.6.
inline constexpr double kAces[] = {0.36 * 2.51, 0.6 * 0.03, 0.36 * 2.43, 0.6 * 0.59, 0.14};

struct Filters {
  ContrastFilters contrast;
  FeatureFilters feature;

  explicit Filters(double pixels_per_degree)
      : contrast(contrast_filters(pixels_per_degree)), feature(feature_filters(pixels_per_degree)) {}
};

// A row, each as long as the picture is wide.
struct SeenRow {
  std::vector<Colour> lab;         // Hunt-adjusted, after the eye's contrast filter
  std::vector<float> edge, point;  // how strong the features are
};

// A band of rows, with those above and below that its filters reach. Pictures go on beyond their borders as they end
// there.
class SeenBand {
 public:
  // Rows first to last - 1.
  SeenBand(const Image& image, const Display& display, const Filters& filters, uint32_t first, uint32_t last);

  void see(uint32_t y, SeenRow& seen) const;

 private:
  enum Plane { kLightness, kRedGreen, kNarrow, kWide, kEdge, kPoint, kGaussian, kPlanes };

  float* row(Plane plane, uint32_t y) { return &planes_[(plane * rows_ + (y - first_)) * size_t{width_}]; }
  // The plane filtered along y.
  void filter(Plane plane, const Weights& weights, uint32_t y, std::vector<float>& out) const;

  const Filters& filters_;
  uint32_t width_, height_, first_;
  size_t rows_;
  std::vector<float> planes_;  // filtered along x
};

}  // namespace lanewise::flip
