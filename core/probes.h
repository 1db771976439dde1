// Probes: pixels that are drawn a second time, with random numbers independent of the first. Half the squared difference of
// two such estimates is the expected squared error of one, whatever samples of one estimate have to do with each other.
#pragma once

#include <cstdint>
#include <vector>

#include "core/film.h"
#include "core/saved_render.h"
#include "core/settings.h"

namespace lanewise {

class Probes {
 public:
  static constexpr uint32_t kMostSpacing = 32;  // one square in so many is a probe,
  static constexpr uint32_t kWanted = 256;      // or more where a picture would have fewer squares of probes

  // No probes if `on` is false. side: of the squares of pixels that are drawn together, and are probes together.
  Probes(const Settings& settings, bool on, uint32_t side = 1);

  // y * width + x of the whole picture: a lattice of squares over the window, square after square.
  const std::vector<uint32_t>& pixels() const { return pixels_; }
  // Whether it is of the same square as the probe before.
  bool continues(size_t probe) const;

  // Samples behind all second estimates, and the number of the next one.
  uint64_t samples() const { return samples_; }
  uint64_t next_sample() const { return kSecondEstimate + first_sample_ + samples_; }

  // Puts the second sums of probes begin .. end - 1 in the place of the film's, to be added to, and the film's in theirs; once
  // more puts all back.
  void exchange(Film& film, size_t begin, size_t end);
  void drew(uint32_t count) { samples_ += count; }

  void save(SavedRender& saved) const;
  void load(const SavedRender& saved);

  // Of a probe, when all is put back: where it is in the window's rows, and its second estimate.
  size_t place(size_t probe) const;
  PixelMean second(size_t probe) const { return pixel_mean(sums_[probe], samples_); }

 private:
  uint32_t width_;
  uint32_t side_;
  Window window_;
  std::vector<uint32_t> pixels_;
  std::vector<PixelSums> sums_;
  uint64_t first_sample_;
  uint64_t samples_ = 0;
};

}  // namespace lanewise
