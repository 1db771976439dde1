#include "core/light_film.h"

#include <algorithm>
#include <bit>
#include <bitset>
#include <utility>

#include "core/packed_sums.h"
#include "core/types.h"
#include "core/workers.h"
#include "hwy/cache_control.h"

namespace lanewise {

LightFilm::LightFilm(size_t pixels) : film_(pixels), band_bits_(static_cast<int>(std::bit_width(pixels / kBands))) {}

// Band by band, so that each lock is taken once at most.
void LightFilm::add(Splats& splats) {
  std::array<size_t, kBands + 1> begin{};
  for (const Splat& splat : splats) ++begin[band_of(splat.pixel) + 1];
  for (size_t k = 0; k < kBands; ++k) begin[k + 1] += begin[k];
  std::array<size_t, kBands + 1> next = begin;
  for (size_t k = 0; k < kBands; ++k) {
    while (next[k] < begin[k + 1]) {
      const size_t home = band_of(splats[next[k]].pixel);
      if (home != k) std::swap(splats[next[k]], splats[next[home]]);
      ++next[home];
    }
  }
  const auto add_band = [&](size_t k) {
    for (size_t i = begin[k]; i < begin[k + 1]; ++i) {
      constexpr size_t kAhead = 8;  // pixels lie in two cache lines each
      const PixelSums& soon = film_.sums[splats[std::min(i + kAhead, splats.size() - 1)].pixel];
      hwy::Prefetch(&soon.r), hwy::Prefetch(&soon.y2);
      film_.sums[splats[i].pixel].add(splats[i].r, splats[i].g, splats[i].b);
    }
  };
  // From another band on than the last thread that came, and those at the end that somebody else is at: so threads do not wait for
  // each other, at the locks or for the same new page.
  const size_t first = came_++ * kStride;
  std::bitset<kBands> left;
  for (size_t k = 0; k < kBands; ++k) left[k] = begin[k] < begin[k + 1];
  for (const bool wait : {false, true}) {
    for (size_t j = 0; j < kBands; ++j) {
      const size_t k = (first + j) % kBands;
      if (!left[k]) continue;
      std::unique_lock lock(locks_[k], std::defer_lock);
      if (wait) lock.lock();
      if (!wait && !lock.try_lock()) continue;
      add_band(k);
      left[k] = false;
    }
  }
}

void LightFilm::add(ByteReader& packed) {
  std::unique_lock<std::mutex> lock;
  for (size_t last = kBands; !packed.empty();) {
    const auto pixel = packed.get<uint32_t>();
    if (pixel >= film_.sums.size()) throw Error("light paths beyond the picture");
    const size_t k = band_of(pixel);
    if (k != last) {
      if (lock) lock.unlock();
      lock = std::unique_lock(locks_[k]);
      last = k;
    }
    film_.sums[pixel] += unpack_sums(packed);
  }
}

std::string pack_splats(Splats& splats) {
  std::ranges::sort(splats, {}, &Splat::pixel);
  std::string packed;
  for (auto next = splats.begin(); next != splats.end();) {
    const uint32_t pixel = next->pixel;
    PixelSums sums;
    for (; next != splats.end() && next->pixel == pixel; ++next) sums.add(next->r, next->g, next->b);
    packed.append(reinterpret_cast<const char*>(&pixel), sizeof pixel);
    pack(sums, packed);
  }
  return packed;
}

void LightFilm::drew(uint64_t passes) {
  for (uint64_t& samples : film_.samples) samples += passes;
}

PixelMean light_mean(const PixelSums& sums, uint64_t passes) {
  if (passes == 0) return {};
  const double scale = 1 / static_cast<double>(passes);
  return {{static_cast<float>(sums.r.as<double>() * scale), static_cast<float>(sums.g.as<double>() * scale),
           static_cast<float>(sums.b.as<double>() * scale)},
          static_cast<float>(sums.y2.as<double>() * scale * scale)};
}

MeanPicture light_picture(const Film& light, uint32_t width, const Window& window, uint32_t threads) {
  MeanPicture picture{window.width, window.height, {}};
  picture.pixels.resize(size_t{window.width} * window.height);
  for_each_row(threads, window.height, [&](uint32_t y) {
    for (uint32_t x = 0; x < window.width; ++x) {
      const size_t i = size_t{window.y + y} * width + window.x + x;
      picture.pixels[size_t{y} * window.width + x] = light_mean(light.sums[i], light.samples[i]);
    }
  });
  return picture;
}

}  // namespace lanewise
