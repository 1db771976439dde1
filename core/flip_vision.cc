#include "core/flip_vision.h"

#include <algorithm>
#include <cmath>

namespace lanewise::flip {

float Display::operator()(float radiance) const {
  if (!tone_mapped) return std::min(radiance, 1.0f);
  const double x = gain * radiance;
  return static_cast<float>(std::min((kAces[0] * x + kAces[1]) * x / ((kAces[2] * x + kAces[3]) * x + kAces[4]), 1.0));
}

SeenBand::SeenBand(const Image& image, const Display& display, const Filters& filters, uint32_t first, uint32_t last)
    : filters_(filters), width_(image.width), height_(image.height) {
  const auto& [contrast, feature] = filters;
  const size_t reach = std::max(contrast.lightness.size(), feature.gaussian.size()) / 2;
  first_ = static_cast<uint32_t>(first - std::min<size_t>(first, reach));
  const auto end = static_cast<uint32_t>(std::min<size_t>(last + reach, height_));
  rows_ = end - first_;
  planes_.resize(kPlanes * rows_ * width_);

  std::vector<float> channels[3];
  for (std::vector<float>& channel : channels) channel.resize(width_ + 2 * reach);
  for (uint32_t y = first_; y < end; ++y) {
    for (uint32_t x = 0; x < width_; ++x) {
      const float* rgb = image.pixel(x, y);
      const Colour colour = ycxcz({display(rgb[0]), display(rgb[1]), display(rgb[2])});
      for (size_t c = 0; c < 3; ++c) channels[c][reach + x] = colour[c];
    }
    for (std::vector<float>& channel : channels) {
      std::fill_n(channel.begin(), reach, channel[reach]);
      std::fill_n(channel.end() - static_cast<ptrdiff_t>(reach), reach, channel[reach + width_ - 1]);
    }
    const auto along_x = [&](Plane plane, const Weights& weights, const std::vector<float>& channel) {
      filter_row(weights, &channel[reach - weights.size() / 2], row(plane, y), width_);
    };
    along_x(kLightness, contrast.lightness, channels[0]);
    along_x(kRedGreen, contrast.red_green, channels[1]);
    along_x(kNarrow, contrast.blue_yellow_narrow, channels[2]);
    along_x(kWide, contrast.blue_yellow_wide, channels[2]);
    for (float& lightness : channels[0]) lightness = (lightness + 16) / 116;
    along_x(kEdge, feature.edge, channels[0]);
    along_x(kPoint, feature.point, channels[0]);
    along_x(kGaussian, feature.gaussian, channels[0]);
  }
}

void SeenBand::filter(Plane plane, const Weights& weights, uint32_t y, std::vector<float>& out) const {
  const auto radius = static_cast<int64_t>(weights.size() / 2);
  std::vector<const float*> rows;
  for (int64_t k = -radius; k <= radius; ++k) {
    const auto at = static_cast<size_t>(std::clamp<int64_t>(y + k, 0, height_ - 1) - first_);
    rows.push_back(&planes_[(plane * rows_ + at) * width_]);
  }
  out.resize(width_);
  filter_column(weights, rows.data(), out.data(), width_);
}

void SeenBand::see(uint32_t y, SeenRow& seen) const {
  const auto& contrast = filters_.contrast;
  const auto& feature = filters_.feature;
  std::vector<float> a, b, c, d;
  filter(kLightness, contrast.lightness, y, a);
  filter(kRedGreen, contrast.red_green, y, b);
  filter(kNarrow, contrast.blue_yellow_narrow, y, c);
  filter(kWide, contrast.blue_yellow_wide, y, d);
  seen.lab.resize(width_);
  for (uint32_t x = 0; x < width_; ++x) {
    Colour rgb = rgb_from_ycxcz({a[x], b[x], c[x] + d[x]});
    for (float& v : rgb) v = std::clamp(v, 0.0f, 1.0f);
    seen.lab[x] = hunt_adjusted_lab(rgb);
  }
  const auto strength = [&](Plane along_x, const Weights& along_y, std::vector<float>& out) {
    filter(along_x, feature.gaussian, y, a);
    filter(kGaussian, along_y, y, b);
    out.resize(width_);
    for (uint32_t x = 0; x < width_; ++x) out[x] = std::sqrt(a[x] * a[x] + b[x] * b[x]);
  };
  strength(kEdge, feature.edge, seen.edge);
  strength(kPoint, feature.point, seen.point);
}

}  // namespace lanewise::flip
