// How many samples each pixel gets: as many as -s says, or, with --allocation noise, more where the picture is noisy and fewer where
// it is calm, as many in all.
//
// n samples of a pixel whose relative standard deviation is sigma leave the relative variance sigma^2 / n; of all ways to deal out a
// number of samples, n ~ sigma has the least sum of these, which is MRSE (Neyman, J. Royal Statistical Society 97, 1934; Cochran,
// Sampling Techniques, 1977, ch. 5.5). sigma is that of a pilot, one sample of every pixel, within blocks of pixels. The pilot's
// samples are thrown away: how many a pixel gets has nothing to do with those that it gets, so its mean stays unbiased. It hangs
// on the scene and the settings alone: a part of a picture, or of its samples, has the same bits as in the whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/pixel_sums.h"

namespace lanewise {

class SavedRender;

class SampleShares {
 public:
  static constexpr uint32_t kBlock = 4;  // pixels a side of a block, of one share: whole squares of core/path_reuse.h
  static constexpr uint32_t kLeast = 2, kMost = 64;  // share of a block, in eighths of the mean

  // The same for every pixel. first_sample: number of the picture's first (--samples).
  explicit SampleShares(uint64_t first_sample) : first_sample_(first_sample) {}

  // By the pilot: sums[y * width + x] of one sample. A picture that is calm everywhere has the same for every pixel.
  SampleShares(uint64_t first_sample, uint32_t width, uint32_t height, const PixelSums* pilot);

  // As save() left them. Throws UsageError for what it cannot have left.
  SampleShares(uint64_t first_sample, uint32_t width, uint32_t height, const SavedRender& saved);
  static bool are_in(const SavedRender& saved);
  void save(SavedRender& saved) const;  // of its area; nothing if they are even

  bool even() const { return eighths_.empty(); }
  // The number of the pixel's block, all of one share.
  size_t block(uint32_t pixel) const { return even() ? 0 : block_of(pixel); }
  // The pixel's share, in eighths.
  uint32_t share(uint32_t pixel) const { return even() ? kEven : eighths_[block_of(pixel)]; }

  // Of a pixel (y * width + x): the number of its first sample, and how many it is to have where the picture has `samples` a pixel:
  // the share of them, rounded up.
  uint64_t first(uint32_t pixel) const { return up_to(pixel, first_sample_); }
  uint64_t count(uint32_t pixel, uint64_t samples) const {
    return up_to(pixel, first_sample_ + samples) - first(pixel);
  }

  // Whether a pixel may have `count`, of several ranges with so many `samples` in all.
  static bool may_be(uint64_t count, uint64_t samples, uint64_t ranges);

  // The most samples of the picture for which `count` of the pixel are enough.
  uint64_t samples_for(uint32_t pixel, uint64_t count) const;

 private:
  static constexpr uint32_t kEven = 8;

  size_t block_of(uint32_t pixel) const { return size_t{pixel / width_ / kBlock} * columns_ + pixel % width_ / kBlock; }
  SampleShares(uint64_t first_sample, uint32_t width)
      : first_sample_(first_sample), width_(width), columns_((width + kBlock - 1) / kBlock) {}
  uint64_t up_to(uint32_t pixel, uint64_t samples) const;

  uint64_t first_sample_;
  uint32_t width_ = 0, columns_ = 0;  // of the picture in pixels, in blocks
  std::vector<uint8_t> eighths_;      // share of each block; empty: all are kEven
};

}  // namespace lanewise
