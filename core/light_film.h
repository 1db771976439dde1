// The film of light paths, which fall on any pixel from any thread.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "core/bytes.h"
#include "core/film.h"
#include "core/splats.h"

namespace lanewise {

class LightFilm {
 public:
  explicit LightFilm(size_t pixels);

  // From any thread. Leaves the list in another order.
  void add(Splats& splats);

  // What pack_splats() has made of some; from any thread.
  void add(ByteReader& packed);

  // So many passes more are done.
  void drew(uint64_t passes);
  uint64_t passes() const { return film_.samples[0]; }

  // Of every pixel its sum over what it has seen, and as the number of its samples that of the passes.
  const Film& film() const { return film_; }
  Film& film() { return film_; }

 private:
  static constexpr size_t kBands = 64;   // of pixels, with a lock each, at most
  static constexpr size_t kStride = 39;  // 64 / golden ratio: those who come begin far from each other
  size_t band_of(uint32_t pixel) const { return pixel >> band_bits_; }

  Film film_;
  int band_bits_;
  std::array<std::mutex, kBands> locks_;
  std::atomic<size_t> came_{0};
};

// Each pixel that they fall on, in rising order, with its sums packed: for another process. Sorts the list.
std::string pack_splats(Splats& splats);

// What light paths add to a pixel, from its sums in a LightFilm. The variance is that of a Poisson process: a pixel sees some of
// very many independent paths.
PixelMean light_mean(const PixelSums& sums, uint64_t passes);
MeanPicture light_picture(const Film& light, uint32_t width, const Window& window, uint32_t threads);

}  // namespace lanewise
