// The film of --noise: as many samples as the noise demands, without the bias of stopping on a lucky sum.
//
// A pixel's samples come in two independent halves. Each half's estimate ends when the *other* half says so, and the picture
// is the mean of the two estimates. How many samples an estimate has is thus independent of their values, and so its
// expectation is the pixel's true value, whatever the rule: the bias is exactly 0. A half speaks for whole blocks of pixels,
// whose samples together see more than one pixel's do, and a block goes on as long as any block around it does: so the rule
// seldom stops where a rare bright path has not been met yet.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/dimensions.h"
#include "core/error_estimate.h"
#include "core/film.h"
#include "core/image.h"
#include "core/saved_render.h"
#include "core/settings.h"
#include "core/zeroed_pages.h"
#include "kernels/kernels.h"

namespace lanewise {

class NoiseFilm {
 public:
  static constexpr uint32_t kHalves = 2;
  static constexpr uint32_t kFirstSamples = 16;  // of each half before anything is decided
  static constexpr uint32_t kBlock = 8;          // side of a block in pixels, on a grid from the picture's corner

  // Draws the blocks that can have a say in the window's pixels, of a picture of width x height. noise: the standard error
  // that luminance may keep, relative to itself + kLeastRadiance, root mean square over a block. max_samples: of a pixel,
  // at least 2 kFirstSamples; odd ones are rounded down.
  NoiseFilm(uint32_t width, uint32_t height, const Window& window, double noise, uint64_t max_samples);

  // The round to draw now: of every pixel of the list drawing(half), count() samples from number first(half) on, added to
  // sums(half)[pixel]. Then end_round(). When count() is 0 there is no more.
  uint32_t count() const { return count_; }
  uint64_t first(uint32_t half) const { return (half == 0 ? 0 : kSecondEstimate) + drawn_; }
  std::vector<uint32_t> drawing(uint32_t half) const;
  PixelSums* sums(uint32_t half) { return halves_[half].film.sums.data(); }
  // For a round that may be left before its end: what has been drawn of it, from any thread; and the pixels that have not been.
  void drew(uint32_t half, const std::vector<uint32_t>& pixels);
  std::vector<uint32_t> behind(uint32_t half) const;
  double round_pixels() const;  // of both halves
  // Before the round is drawn: to fewer samples. To 0: end_round() then ends all estimates as they are.
  void shorten(uint32_t count);
  void end_round();

  // With all that it has drawn, also of the round.
  void save(SavedRender& saved) const;
  void load(const SavedRender& saved);

  // Samples drawn in all up to the round, and how many it will be, as far as can be said from the noise that is left.
  double drawn() const { return total_; }
  double expected() const { return total_ + left_; }

  // Of the window: its picture, as it would be if the film ended now; the samples drawn for each pixel; and the share of its
  // pixels whose block came to the noise asked for before max_samples.
  Image develop() const;
  ZeroedVector<uint64_t> sample_counts() const;
  double converged() const;

  // Of the window, as it would be if the film ended now. After the first round.
  ErrorEstimate estimate_error(uint32_t threads) const;

 private:
  struct Half {
    Film film;                                    // of all samples, also those behind the estimate's end
    std::vector<std::array<double, 3>> estimate;  // mean RGB
    // A block each:
    std::vector<uint8_t> converged;  // 1: these samples say that the other half may stop; for good
    std::vector<uint8_t> ended;      // 1: the estimate is made

    explicit Half(size_t pixels) : film(pixels), estimate(pixels) {}
    bool draws(uint32_t block) const { return !ended[block] || !converged[block]; }
  };

  // The noise that the block would have if both halves had as many samples as this one, over what it may have.
  double excess(const Half& half, uint32_t block) const;
  bool converged_around(const Half& half, uint32_t block) const;
  uint32_t blocks() const { return blocks_.width * blocks_.height; }
  // The pixels that are drawn.
  Window area() const;
  template <class F>
  void for_each_pixel(uint32_t block, const F& f) const;
  uint32_t block_of(uint32_t x, uint32_t y) const;
  // Mean RGB of the half's samples up to its estimate's end, or so far.
  std::array<double, 3> mean(const Half& half, uint32_t x, uint32_t y) const;

  uint32_t width_, height_;
  Window window_;
  double noise_;
  uint64_t max_drawn_;  // of a half
  Window blocks_;       // that are drawn, in blocks
  uint64_t drawn_ = 0;  // by each half that still draws, before the round
  uint32_t count_ = 0;
  double total_ = 0, left_ = 0;
  std::array<Half, kHalves> halves_;
};

}  // namespace lanewise
