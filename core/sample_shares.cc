#include "core/sample_shares.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/saved_render.h"
#include "core/settings.h"

namespace lanewise {
namespace {

constexpr double kLeastRadiance = 0.01;  // MRSE's

// In eighths. Powers of two, at which sequences of low discrepancy are at their best, and one step between.
constexpr uint8_t kSteps[] = {2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64};
static_assert(kSteps[0] == SampleShares::kLeast && *std::rbegin(kSteps) == SampleShares::kMost);

constexpr const char* kSaved = "shares";

// The next to it, by ratio.
uint8_t step_near(double eighths) {
  size_t k = 0;
  while (k + 1 < std::size(kSteps) && eighths * eighths > static_cast<double>(kSteps[k]) * kSteps[k + 1]) ++k;
  return kSteps[k];
}

struct Grid {
  uint32_t columns, rows;

  // The mean over the blocks around each, itself among them.
  std::vector<double> smooth(const std::vector<double>& values) const {
    std::vector<double> means(values.size());
    for (uint32_t row = 0; row < rows; ++row) {
      for (uint32_t column = 0; column < columns; ++column) {
        double sum = 0, n = 0;
        for (uint32_t j = row - std::min(row, 1u); j < std::min(row + 2, rows); ++j) {
          for (uint32_t i = column - std::min(column, 1u); i < std::min(column + 2, columns); ++i) {
            sum += values[size_t{j} * columns + i];
            n += 1;
          }
        }
        means[size_t{row} * columns + column] = sum / n;
      }
    }
    return means;
  }
};

}  // namespace

SampleShares::SampleShares(uint64_t first_sample, uint32_t width, uint32_t height, const PixelSums* pilot)
    : SampleShares(first_sample, width) {
  const Grid grid{columns_, (height + kBlock - 1) / kBlock};
  const size_t blocks = size_t{grid.columns} * grid.rows;
  std::vector<double> pixels(blocks);
  std::array<std::vector<double>, 3> mean, square;  // by channel
  mean.fill(pixels), square.fill(pixels);
  for (uint32_t pixel = 0; pixel < width * height; ++pixel) {
    const size_t block = block_of(pixel);
    const PixelSums& sums = pilot[pixel];
    const double rgb[] = {sums.r.as<double>(), sums.g.as<double>(), sums.b.as<double>()};
    pixels[block] += 1;
    for (size_t c = 0; c < 3; ++c) mean[c][block] += rgb[c], square[c][block] += rgb[c] * rgb[c];
  }
  std::vector<double> variance(blocks);  // relative, within the block
  for (size_t c = 0; c < 3; ++c) {
    for (size_t b = 0; b < blocks; ++b) mean[c][b] /= pixels[b];
    const std::vector<double> around = grid.smooth(mean[c]);
    for (size_t b = 0; b < blocks; ++b) {
      const double level = around[b] + kLeastRadiance;
      variance[b] += std::max(0.0, square[c][b] / pixels[b] - mean[c][b] * mean[c][b]) / (level * level);
    }
  }
  std::vector<double> sigma = grid.smooth(variance);
  double sum = 0;
  for (size_t b = 0; b < blocks; ++b) sum += pixels[b] * (sigma[b] = std::sqrt(sigma[b]));
  const double all = static_cast<double>(width) * height;
  if (sum == 0) return;

  // The largest shares that come to no more than all samples.
  eighths_.resize(blocks);
  const auto deal = [&](double scale) {
    double dealt = 0;
    for (size_t b = 0; b < blocks; ++b) dealt += pixels[b] * (eighths_[b] = step_near(scale * sigma[b] * all / sum));
    return dealt;
  };
  double low = 0, high = 1e6;
  for (int i = 0; i < 60; ++i) {
    const double scale = (low + high) / 2;
    (deal(scale) <= kEven * all ? low : high) = scale;
  }
  deal(low);
}

SampleShares::SampleShares(uint64_t first_sample, uint32_t width, uint32_t height, const SavedRender& saved)
    : SampleShares(first_sample, width) {
  eighths_.assign(size_t{columns_} * ((height + kBlock - 1) / kBlock), 0);
  saved.get<uint32_t>(kSaved, width, [&](size_t pixel, uint32_t eighths) {
    uint8_t& share = eighths_[block_of(static_cast<uint32_t>(pixel))];
    const bool known = std::ranges::find(kSteps, eighths) != std::end(kSteps);
    saved.check(known && (share == 0 || share == eighths), "damaged: its shares of samples cannot be");
    share = static_cast<uint8_t>(eighths);
  });
}

bool SampleShares::are_in(const SavedRender& saved) { return saved.has(kSaved); }

void SampleShares::save(SavedRender& saved) const {
  if (!even()) saved.put(kSaved, width_, [&](size_t pixel) { return share(static_cast<uint32_t>(pixel)); });
}

uint64_t SampleShares::up_to(uint32_t pixel, uint64_t samples) const {
  if (even()) return samples;
  const Uint128 eighths = Uint128{samples} * share(pixel);
  return static_cast<uint64_t>(std::min<Uint128>((eighths + kEven - 1) / kEven, kMaxSpp));
}

bool SampleShares::may_be(uint64_t count, uint64_t samples, uint64_t ranges) {
  // Shares are rounded at both ends of a range.
  const Uint128 eighths = Uint128{count} * kEven, slack = Uint128{ranges} * kEven;
  return eighths + slack >= Uint128{samples} * kLeast && eighths <= Uint128{samples} * kMost + slack;
}

uint64_t SampleShares::samples_for(uint32_t pixel, uint64_t count) const {
  return static_cast<uint64_t>(Uint128{first(pixel) + count} * kEven / share(pixel)) - first_sample_;
}

}  // namespace lanewise
