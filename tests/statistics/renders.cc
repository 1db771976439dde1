#include "tests/statistics/renders.h"

#include <algorithm>
#include <cmath>

#include "core/render.h"
#include "kernels/kernels.h"

namespace lanewise::test {
namespace {

// Relative difference that rounding alone can make between renders in float and in double.
constexpr double kRounding = 2e-6;

double luminance_at(const Image& image, size_t pixel) {
  const float* rgb = &image.rgb[3 * pixel];
  return luminance(rgb[0], rgb[1], rgb[2]);
}

// Black pictures stay 0 apart.
double relative(double x, double level) { return level > 0 ? x / level : x; }

size_t pixel_count(const Image& image) { return size_t{image.width} * image.height; }

double pixel_p(const Moments& a, const Moments& b) { return welch_p(a, b, kRounding * std::abs(b.mean())); }

}  // namespace

Image simd(const Plan& plan) { return render(plan).image; }
Image reference(const Plan& plan) { return render_reference<double>(plan).image; }

std::vector<Image> independent_renders(Plan& plan, const Renderer& renderer, uint64_t first_seed, uint32_t count) {
  std::vector<Image> pictures;
  for (uint32_t i = 0; i < count; ++i) {
    plan.settings.seed = first_seed + i;
    pictures.push_back(renderer(plan));
  }
  return pictures;
}

std::vector<Moments> block_moments(const std::vector<Image>& pictures, uint32_t side) {
  const uint32_t width = pictures[0].width, height = pictures[0].height;
  const uint32_t columns = (width + side - 1) / side, rows = (height + side - 1) / side;
  std::vector<Moments> blocks(size_t{columns} * rows);
  for (const Image& picture : pictures) {
    for (uint32_t block = 0; block < blocks.size(); ++block) {
      const uint32_t x0 = block % columns * side, y0 = block / columns * side;
      const uint32_t x1 = std::min(x0 + side, width), y1 = std::min(y0 + side, height);
      double sum = 0;
      for (uint32_t y = y0; y < y1; ++y) {
        for (uint32_t x = x0; x < x1; ++x) sum += luminance_at(picture, size_t{y} * width + x);
      }
      blocks[block].add(sum / ((x1 - x0) * (y1 - y0)));
    }
  }
  return blocks;
}

Unpaired compare_unpaired(const std::vector<Image>& a, const std::vector<Image>& b, uint32_t block_side) {
  Unpaired result{};
  const std::vector<Moments> pixels_a = block_moments(a, 1), pixels_b = block_moments(b, 1);
  const double level = sidak(0.01, pixels_a.size());
  for (size_t i = 0; i < pixels_a.size(); ++i) {
    result.pixels_passed += (pixel_p(pixels_a[i], pixels_b[i]) >= level) / double(pixels_a.size());
  }
  const std::vector<Moments> blocks_a = block_moments(a, block_side), blocks_b = block_moments(b, block_side);
  for (size_t i = 0; i < blocks_a.size(); ++i) {
    const double p = pixel_p(blocks_a[i], blocks_b[i]);
    if (p < 1) result.block_p.push_back(p);
  }
  const uint32_t whole = std::max(a[0].width, a[0].height);
  const Moments mean_a = block_moments(a, whole)[0], mean_b = block_moments(b, whole)[0];
  result.mean_p = pixel_p(mean_a, mean_b);
  result.difference = relative(mean_a.mean() - mean_b.mean(), mean_b.mean());
  result.error = relative(std::sqrt(mean_a.mean_variance() + mean_b.mean_variance()), mean_b.mean());
  return result;
}

Paired compare_paired(const std::vector<Image>& a, const std::vector<Image>& b) {
  Moments difference, level;
  double differing = 0;
  for (size_t k = 0; k < a.size(); ++k) {
    for (size_t i = 0; i < pixel_count(a[k]); ++i) {
      const double x = luminance_at(a[k], i), y = luminance_at(b[k], i);
      difference.add(x - y);
      level.add(y);
      if (std::abs(x - y) > 0.01 * y) ++differing;
    }
  }
  return {differing / double(level.count()), relative(difference.mean(), level.mean()),
          relative(std::sqrt(difference.mean_variance()), level.mean())};
}

std::vector<double> histogram_of_ten(const std::vector<double>& p_values) {
  std::vector<double> bins(10);
  for (const double p : p_values) bins[std::min<size_t>(9, static_cast<size_t>(p * 10))] += 1;
  return bins;
}

double uniform_p(const std::vector<double>& p_values) {
  return chi_square_p(histogram_of_ten(p_values), std::vector<double>(10, double(p_values.size()) / 10));
}

}  // namespace lanewise::test
