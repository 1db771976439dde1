#include "core/sample_shares.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

#include "core/dimensions.h"
#include "core/image_compare.h"
#include "core/path_reuse.h"
#include "core/saved_render.h"
#include "core/workers.h"
#include "core/zeroed_pages.h"

namespace lanewise {
namespace {

// In eighths. Powers of two, at which sequences of low discrepancy are at their best, and one step between.
constexpr uint8_t kSteps[] = {2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64};
static_assert(kSteps[0] == SampleShares::kLeast && *std::rbegin(kSteps) == SampleShares::kMost);

// Of the mean sigma: what a block has at least. It counts where few blocks have nearly all the noise that was met, and as
// many samples as they may have: then the others share the rest.
constexpr double kLeastSigma = 0.125;

// A pixel's two estimates have no sample in common.
static_assert(kMaxSpp / SampleShares::kEven * SampleShares::kMost <= kSecondEstimate);

// A picture's squares of any other kind are whole in these.
static_assert(SampleShares::kSquare % kTogetherSide == 0);

struct Block {
  double pixels = 0;
  std::array<double, 3> sum{}, squares{};  // over them, by channel
};

template <class T>
using ByColour = std::array<T, SampleShares::kColours>;

struct Grid {
  uint32_t columns, rows;

  size_t size() const { return size_t{columns} * rows; }
  // f(colour, block) for all. Rows are shared out to threads.
  template <class F>
  void for_each_block(uint32_t threads, const F& f) const {
    for_each_row(threads, SampleShares::kColours * rows, [&](uint32_t i) {
      const size_t begin = size_t{i / SampleShares::kColours} * columns;
      for (size_t b = begin; b < begin + columns; ++b) f(i % SampleShares::kColours, b);
    });
  }

  // f(other) for the blocks around one, itself among them.
  template <class F>
  void for_each_around(size_t block, const F& f) const {
    const auto row = static_cast<uint32_t>(block / columns), column = static_cast<uint32_t>(block % columns);
    for (uint32_t j = row - std::min(row, 1u); j < std::min(row + 2, rows); ++j) {
      for (uint32_t i = column - std::min(column, 1u); i < std::min(column + 2, columns); ++i) {
        f(size_t{j} * columns + i);
      }
    }
  }
};

// Of the samples in each block, and around it: the relative variance within blocks. For every colour.
ByColour<std::vector<double>> relative_deviations(const Grid& grid, const ByColour<std::span<Block>>& blocks,
                                                  uint32_t threads) {
  ByColour<std::vector<double>> variances, deviations;  // variances: times pixels
  variances.fill(std::vector<double>(grid.size())), deviations.fill(std::vector<double>(grid.size()));
  grid.for_each_block(threads, [&](size_t colour, size_t b) {
    const Block& block = blocks[colour][b];
    if (block.pixels == 0) return;
    for (size_t c = 0; c < 3; ++c) {
      double pixels = 0, sum = 0;
      grid.for_each_around(b, [&](size_t i) { pixels += blocks[colour][i].pixels, sum += blocks[colour][i].sum[c]; });
      const double level = sum / pixels + kLeastRadiance, own = block.sum[c];
      variances[colour][b] += std::max(0.0, block.squares[c] - own * own / block.pixels) / (level * level);
    }
  });
  grid.for_each_block(threads, [&](size_t colour, size_t b) {
    double pixels = 0, sum = 0;
    grid.for_each_around(b, [&](size_t i) { pixels += blocks[colour][i].pixels, sum += variances[colour][i]; });
    if (pixels > 0) deviations[colour][b] = std::sqrt(sum / pixels);
  });
  return deviations;
}

// Steps in proportion to sigma, each the next by ratio, the largest that come to no more than kEven for each pixel. pixels: of each
// block.
std::vector<uint8_t> deal(std::vector<double> sigma, std::span<const Block> blocks) {
  double all = 0, sum = 0;
  for (size_t b = 0; b < blocks.size(); ++b) all += blocks[b].pixels, sum += blocks[b].pixels * sigma[b];
  std::vector<uint8_t> steps(blocks.size(), SampleShares::kEven);
  if (sum == 0) return steps;
  for (double& s : sigma) s = std::max(s / (sum / all), kLeastSigma);

  // The calmest first, and how many pixels there are before each.
  std::vector<uint32_t> order(blocks.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](uint32_t b) { return sigma[b]; });
  std::vector<double> pixels_before = {0};
  for (const uint32_t b : order) pixels_before.push_back(pixels_before.back() + blocks[b].pixels);
  // How many blocks have no more than step k, at that scale.
  const auto up_to_step = [&](size_t k, double scale) {
    if (k + 1 == std::size(kSteps)) return order.size();
    const double most = std::sqrt(static_cast<double>(kSteps[k]) * kSteps[k + 1]) / scale;
    return static_cast<size_t>(std::ranges::upper_bound(order, most, {}, [&](uint32_t b) { return sigma[b]; }) -
                               order.begin());
  };
  const auto dealt = [&](double scale) {
    double eighths = 0;
    size_t begin = 0;
    for (size_t k = 0; k < std::size(kSteps); ++k) {
      const size_t end = up_to_step(k, scale);
      eighths += (pixels_before[end] - pixels_before[begin]) * kSteps[k];
      begin = end;
    }
    return eighths;
  };
  // From where all are the least to where all are the most, to a millionth.
  double low = -32, high = 16;
  for (int i = 0; i < 26; ++i) {
    const double middle = (low + high) / 2;
    (dealt(std::exp2(middle)) <= SampleShares::kEven * all ? low : high) = middle;
  }
  size_t begin = 0;
  for (size_t k = 0; k < std::size(kSteps); ++k) {
    const size_t end = up_to_step(k, std::exp2(low));
    for (; begin < end; ++begin) steps[order[begin]] = kSteps[k];
  }
  return steps;
}

}  // namespace

SampleShares::SampleShares(uint64_t first_sample, uint32_t width, uint32_t height, const Window& drawn,
                           const PixelSums* sums, uint32_t threads)
    : SampleShares(first_sample, width) {
  const Grid grid{columns_, (height + kBlock - 1) / kBlock};
  ZeroedVector<Block> all(kColours * grid.size());
  ByColour<std::span<Block>> blocks;
  for (size_t c = 0; c < kColours; ++c) blocks[c] = std::span(all).subspan(c * grid.size(), grid.size());
  for_each_row(threads, grid.rows, [&](uint32_t row) {
    const uint32_t begin = std::max(row * kBlock, drawn.y), end = std::min((row + 1) * kBlock, drawn.y + drawn.height);
    for (uint32_t y = begin; y < end; ++y) {
      for (uint32_t x = drawn.x; x < drawn.x + drawn.width; ++x) {
        const PixelSums& pixel = sums[size_t{y} * width + x];
        Block& block = blocks[colour(x, y)][size_t{row} * columns_ + x / kBlock];
        const double rgb[] = {pixel.r.as<double>(), pixel.g.as<double>(), pixel.b.as<double>()};
        block.pixels += 1;
        for (size_t c = 0; c < 3; ++c) block.sum[c] += rgb[c], block.squares[c] += rgb[c] * rgb[c];
      }
    }
  });
  const ByColour<std::vector<double>> deviations = relative_deviations(grid, blocks, threads);
  eighths_.resize(kColours * grid.size());
  for_each_row(threads, kColours, [&](uint32_t colour) {
    const uint32_t other = kColours - 1 - colour;
    const std::vector<uint8_t> steps = deal(deviations[other], blocks[other]);
    for (size_t b = 0; b < steps.size(); ++b) eighths_[b * kColours + colour] = steps[b];
  });
  if (std::ranges::all_of(eighths_, [](uint8_t share) { return share == kEven; })) eighths_.clear();
}

std::optional<SampleShares> SampleShares::saved(uint64_t first_sample, uint32_t width, uint32_t height,
                                                const SavedRender& saved) {
  if (!saved.has(kSaved)) return std::nullopt;
  SampleShares shares(first_sample, width);
  shares.eighths_.assign(kColours * size_t{shares.columns_} * ((height + kBlock - 1) / kBlock), 0);
  bool can_be = true, even = true;
  saved.get<uint32_t>(kSaved, width, [&](size_t pixel, uint32_t eighths) {
    uint8_t& share = shares.eighths_[shares.group_of(static_cast<uint32_t>(pixel))];
    can_be &= std::ranges::find(kSteps, eighths) != std::end(kSteps) && (share == 0 || share == eighths);
    even &= eighths == kEven;
    share = static_cast<uint8_t>(eighths);
  });
  if (!can_be) return std::nullopt;
  return even ? SampleShares(first_sample) : shares;
}

void SampleShares::save(SavedRender& saved, uint32_t width) const {
  saved.put(kSaved, width, [&](size_t pixel) { return share(static_cast<uint32_t>(pixel)); });
}

uint64_t SampleShares::up_to(uint32_t pixel, uint64_t samples) const {
  if (even()) return samples;
  const Uint128 eighths = Uint128{samples} * share(pixel);
  return static_cast<uint64_t>((eighths + kEven - 1) / kEven);
}

uint64_t SampleShares::samples_for(uint32_t pixel, uint64_t count) const {
  return static_cast<uint64_t>(Uint128{first(pixel) + count} * kEven / share(pixel)) - first_sample_;
}

}  // namespace lanewise
