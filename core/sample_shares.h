// How many samples each pixel gets: as many as -s says, or, with --allocation noise, more where the picture is noisy and fewer where
// it is calm, as many in all.
//
// n samples of a pixel whose relative standard deviation is sigma leave the relative variance sigma^2 / n; of all ways to deal out a
// number of samples, n ~ sigma has the least sum of these, which is MRSE (Neyman, J. Royal Statistical Society 97, 1934; Cochran,
// Sampling Techniques, 1977, ch. 5.5). sigma is estimated within blocks of pixels from the first sample of each.
//
// How many samples a pixel gets must have nothing to do with what they are, or its mean is biased. So the picture is cut into two
// colours, as a chessboard is, by squares of pixels that are independent of each other: the shares of each colour are made of
// samples of the other alone. (Cross-fitting: each half of the data tunes what the other estimates. Chernozhukov et al., Double/
// debiased machine learning, Econometrics Journal 21, 2018.) No sample is drawn for the shares alone, and none is lost.
//
// They hang on the scene and the settings alone: a part of a picture, or of its samples, has the same bits as in the whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/pixel_sums.h"
#include "core/settings.h"

namespace lanewise {

class SavedRender;

class SampleShares {
 public:
  // Pixels a side of a square of one colour: one whose pixels hang together (core/path_reuse.h). And of a block, in which each colour
  // has one share.
  static constexpr uint32_t kSquare = 2, kBlock = 2 * kSquare, kColours = 2;
  static constexpr uint32_t colour(uint32_t x, uint32_t y) { return (x / kSquare + y / kSquare) % kColours; }
  static constexpr uint32_t kLeast = 2, kEven = 8, kMost = 64;  // share of a block, in eighths of the mean

  // The same for every pixel. first_sample: number of the picture's first (--samples).
  explicit SampleShares(uint64_t first_sample) : first_sample_(first_sample) {}

  // By the first sample of every pixel in `drawn`: sums[y * width + x]. Pixels that look calm everywhere have the same. The same for
  // any number of threads.
  SampleShares(uint64_t first_sample, uint32_t width, uint32_t height, const Window& drawn, const PixelSums* sums,
               uint32_t threads);

  // As save() left them of a picture that wide. Nothing if it cannot have left this.
  static constexpr const char* kSaved = "shares";
  static std::optional<SampleShares> saved(uint64_t first_sample, uint32_t width, uint32_t height,
                                           const SavedRender& saved);
  void save(SavedRender& saved, uint32_t width) const;  // of its area

  bool even() const { return eighths_.empty(); }
  // A number for the pixels that have one share: those of its colour in its block.
  size_t group(uint32_t pixel) const { return even() ? 0 : group_of(pixel); }
  // The pixel's share, in eighths; its samples for each of the picture's.
  uint32_t share(uint32_t pixel) const { return even() ? kEven : eighths_[group_of(pixel)]; }
  double mean_count(uint32_t pixel) const { return static_cast<double>(share(pixel)) / kEven; }

  // Of a pixel (y * width + x): the number of its first sample, and how many it is to have where the picture has `samples` a pixel:
  // the share of them, rounded up.
  uint64_t first(uint32_t pixel) const { return up_to(pixel, first_sample_); }
  uint64_t count(uint32_t pixel, uint64_t samples) const {
    return up_to(pixel, first_sample_ + samples) - first(pixel);
  }

  // The most samples of the picture for which `count` of the pixel are enough.
  uint64_t samples_for(uint32_t pixel, uint64_t count) const;

 private:
  size_t group_of(uint32_t pixel) const {
    const uint32_t x = pixel % width_, y = pixel / width_;
    return (size_t{y / kBlock} * columns_ + x / kBlock) * kColours + colour(x, y);
  }
  SampleShares(uint64_t first_sample, uint32_t width)
      : first_sample_(first_sample), width_(width), columns_((width + kBlock - 1) / kBlock) {}
  uint64_t up_to(uint32_t pixel, uint64_t samples) const;

  uint64_t first_sample_;
  uint32_t width_ = 0, columns_ = 0;  // of the picture in pixels, in blocks
  std::vector<uint8_t> eighths_;      // share of each group; empty: all are kEven
};

}  // namespace lanewise
