#include "core/probes.h"

#include <algorithm>
#include <bit>
#include <utility>
namespace lanewise {

Probes::Probes(const Settings& settings, bool on) : width_(settings.width), window_(settings.window()) {
  if (!on) return;
  const uint64_t pixels = uint64_t{window_.width} * window_.height;
  // A rank-1 lattice x + g y = 0 mod n, n a power of two, with g near n / golden ratio^2: no two probes are near each other.
  const uint32_t n = std::bit_floor(static_cast<uint32_t>(std::clamp<uint64_t>(pixels / kWanted, 1, kMostSpacing)));
  const uint32_t g = (3 * n + 4) / 8;
  for (uint32_t y = window_.y; y < window_.y + window_.height; ++y) {
    for (uint32_t x = window_.x; x < window_.x + window_.width; ++x) {
      if ((x + g * y) % n == 0) pixels_.push_back(y * settings.width + x);
    }
  }
  sums_.resize(pixels_.size());
}

size_t Probes::place(size_t probe) const {
  const uint32_t x = pixels_[probe] % width_ - window_.x, y = pixels_[probe] / width_ - window_.y;
  return size_t{y} * window_.width + x;
}

void Probes::exchange(Film& film, size_t begin, size_t end) {
  for (size_t i = begin; i < end; ++i) std::swap(film.sums[pixels_[i]], sums_[i]);
}

}  // namespace lanewise
