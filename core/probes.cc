#include "core/probes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "core/dimensions.h"

namespace lanewise {

Probes::Probes(const Settings& settings, const SampleShares& shares, bool on, uint32_t side)
    : width_(settings.width), side_(side), window_(settings.window()), shares_(shares) {
  if (!on) return;
  const uint64_t squares = uint64_t{window_.width} * window_.height / (side * side);
  // A rank-1 lattice x + g y = 0 mod n, n a power of two, with g near n / golden ratio^2: no two probes are near each other. g is
  // odd, so that n rows have a probe in every column: the narrowest window has some.
  constexpr std::array<uint32_t, std::bit_width(kMostSpacing)> kSteps = {0, 1, 1, 3, 5, 13};
  const uint32_t n = std::bit_floor(static_cast<uint32_t>(std::clamp<uint64_t>(squares / kWanted, 1, kMostSpacing)));
  const uint32_t g = kSteps[std::bit_width(n) - 1];
  const uint32_t x_end = window_.x + window_.width, y_end = window_.y + window_.height;
  for (uint32_t row = window_.y / side; row * side < y_end; ++row) {
    for (uint32_t column = window_.x / side; column * side < x_end; ++column) {
      if ((column + g * row) % n != 0) continue;
      for (uint32_t y = std::max(row * side, window_.y); y < std::min((row + 1) * side, y_end); ++y) {
        for (uint32_t x = std::max(column * side, window_.x); x < std::min((column + 1) * side, x_end); ++x) {
          pixels_.push_back(y * settings.width + x);
        }
      }
    }
  }
  std::ranges::stable_sort(pixels_, {}, [&](uint32_t pixel) { return shares_.share(pixel); });
  sums_.resize(pixels_.size());
}

size_t Probes::end_of_portion(size_t begin, size_t most) const {
  size_t end = begin;
  while (end < pixels_.size() && shares_.share(pixels_[end]) == shares_.share(pixels_[begin]) &&
         (end < begin + most || continues(end))) {
    ++end;
  }
  return end;
}

bool Probes::continues(size_t probe) const {
  const auto square = [this](uint32_t pixel) { return std::pair(pixel % width_ / side_, pixel / width_ / side_); };
  return probe > 0 && square(pixels_[probe]) == square(pixels_[probe - 1]);
}

size_t Probes::place(size_t probe) const {
  const uint32_t x = pixels_[probe] % width_ - window_.x, y = pixels_[probe] / width_ - window_.y;
  return size_t{y} * window_.width + x;
}

void Probes::exchange(Film& film, size_t begin, size_t end) {
  for (size_t i = begin; i < end; ++i) std::swap(film.sums[pixels_[i]], sums_[i]);
}

void Probes::save(SavedRender& saved) const {
  if (pixels_.empty()) return;
  Film film(size_t{width_} * (window_.y + window_.height));
  for (size_t i = 0; i < pixels_.size(); ++i) {
    film.sums[pixels_[i]] = sums_[i];
    film.samples[pixels_[i]] = drawn(i);
  }
  saved.put_film("probes", width_, film);
}

void Probes::load(const SavedRender& saved, uint64_t most) {
  if (pixels_.empty() || !saved.has_film("probes")) return;
  Film film(size_t{width_} * (window_.y + window_.height));
  saved.get_film("probes", width_, film);
  samples_ = most;
  for (size_t i = 0; i < pixels_.size(); ++i) {
    sums_[i] = film.sums[pixels_[i]];
    samples_ = std::min(samples_, shares_.samples_for(pixels_[i], film.samples[pixels_[i]]));
  }
  for (size_t i = 0; i < pixels_.size(); ++i) {
    saved.check(film.samples[pixels_[i]] == drawn(i), "damaged: its probes have not the samples of one picture");
  }
}

}  // namespace lanewise
