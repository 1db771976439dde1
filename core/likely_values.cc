#include "core/likely_values.h"

#include "core/image_compare.h"
#include "core/near_pixels.h"
#include "core/workers.h"

namespace lanewise {
namespace {

// Of a pixel's own variance. A bright path raises a pixel's mean and, by the same samples, its variance: their difference from what
// is around says less than one from variances known beforehand would. Measured, as kDoubt in core/error_estimate.cc.
constexpr double kOwnDoubt = 2;

// Towards what is likelier, by what noise of that variance explains of their difference.
std::array<double, 3> shrink(const std::array<double, 3>& value, std::array<double, 3> towards, double variance) {
  const double difference = luminance(value) - luminance(towards), square = difference * difference;
  const double kept = variance < square ? 1 - variance / square : 0;
  for (size_t c = 0; c < 3; ++c) towards[c] += kept * (value[c] - towards[c]);
  return towards;
}

}  // namespace

LikelyValues::LikelyValues(const MeanPicture& picture, uint32_t threads)
    : picture_(picture),
      columns_((picture.width + kBlock - 1) / kBlock),
      rows_((picture.height + kBlock - 1) / kBlock),
      around_(size_t{columns_} * rows_) {
  std::vector<Group> blocks(around_.size());
  for_each_row(threads, rows_, [&](uint32_t row) {
    for (uint32_t y = row * kBlock; y < std::min((row + 1) * kBlock, picture.height); ++y) {
      for (uint32_t x = 0; x < picture.width; ++x) {
        blocks[size_t{row} * columns_ + x / kBlock].add(picture.pixels[size_t{y} * picture.width + x]);
      }
    }
  });
  for_each_row(threads, rows_, [&](uint32_t row) {
    for (uint32_t column = 0; column < columns_; ++column) {
      Group& around = around_[size_t{row} * columns_ + column];
      for (uint32_t j = row - std::min(row, 1u); j < std::min(row + 2, rows_); ++j) {
        for (uint32_t i = column - std::min(column, 1u); i < std::min(column + 2, columns_); ++i) {
          around.add(blocks[size_t{j} * columns_ + i]);
        }
      }
    }
  });
}

size_t LikelyValues::bytes_per_pixel() { return 2 * sizeof(Group) / (kBlock * kBlock); }

std::array<double, 3> LikelyValues::operator()(uint32_t x, uint32_t y, const PixelMean& centre) const {
  Group own, near, square;
  own.add(centre);
  for_each_near(picture_, x, y, [&](const PixelMean& pixel, bool together) { (together ? square : near).add(pixel); });
  if (near.pixels == 0) return own.sum;
  Group far = around_[size_t{y / kBlock} * columns_ + x / kBlock];
  far.take(near), far.take(square);
  // Pixels that have met no bright path yet may not pass for calm beside noisy ones.
  std::array<double, 3> towards = near.mean();
  if (far.pixels > 0) {
    towards = shrink(towards, far.mean(), std::max(near.mean_variance(), far.mean_variance() / 2) / near.pixels);
  }
  return shrink(own.sum, towards, kOwnDoubt * std::max(own.variance, near.mean_variance() / 2));
}

}  // namespace lanewise
