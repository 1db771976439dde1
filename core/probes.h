// Probes: pixels that are drawn a second time, with random numbers independent of the first. Half the squared difference of
// two such estimates is the expected squared error of one, whatever samples of one estimate have to do with each other.
#pragma once

#include <cstdint>
#include <vector>

#include "core/film.h"
#include "core/sample_shares.h"
#include "core/saved_render.h"
#include "core/settings.h"

namespace lanewise {

class Probes {
 public:
  static constexpr uint32_t kMostSpacing = 32;  // one square in so many is a probe,
  static constexpr uint32_t kWanted = 256;      // or more where a picture would have fewer squares of probes

  // No probes if `on` is false. side: of the squares of pixels that are drawn together, and are probes together.
  Probes(const Settings& settings, const SampleShares& shares, bool on, uint32_t side = 1);

  // y * width + x of the whole picture: a lattice of squares over the window, square after square, those of one share together.
  const std::vector<uint32_t>& pixels() const { return pixels_; }
  // Whether it is of the same square as the probe before.
  bool continues(size_t probe) const;

  // Samples a pixel of the picture that all second estimates have their share of; of a probe, those behind it, and the number of
  // its next one.
  uint64_t samples() const { return samples_; }
  uint64_t drawn(size_t probe) const { return shares_.count(pixels_[probe], samples_); }
  uint64_t least_drawn() const {
    return pixels_.empty() ? 0 : drawn(0);
  }  // of all, as those of the least share come first
  uint64_t next_sample(size_t probe) const { return kSecondEstimate + shares_.first(pixels_[probe]) + drawn(probe); }
  // Probes of one share, in whole squares, begin .. end - 1: at most some `most` from `begin` on.
  size_t end_of_portion(size_t begin, size_t most) const;

  // Puts the second sums of probes begin .. end - 1 in the place of the film's, to be added to, and the film's in theirs; once
  // more puts all back.
  void exchange(Film& film, size_t begin, size_t end);
  void drew(uint32_t count) { samples_ += count; }

  void save(SavedRender& saved) const;
  // Throws UsageError if no number of samples, up to `most`, gives the probes as many as they have.
  void load(const SavedRender& saved, uint64_t most);

  // Of a probe, when all is put back: where it is in the window's rows, and its second estimate.
  size_t place(size_t probe) const;
  PixelMean second(size_t probe) const { return pixel_mean(sums_[probe], drawn(probe)); }

 private:
  uint32_t width_;
  uint32_t side_;
  Window window_;
  std::vector<uint32_t> pixels_;
  std::vector<PixelSums> sums_;
  SampleShares shares_;
  uint64_t samples_ = 0;
};

}  // namespace lanewise
