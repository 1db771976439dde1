#include "core/schedule.h"

#include <algorithm>

#include "core/film.h"
#include "core/noise_film.h"
#include "core/tile.h"
#include "core/workers.h"

namespace lanewise {
namespace {

// -s and -a. Of a tile's pixels, batch after batch goes to those that have not converged.
Exposure expose_tiles(const Settings& settings, uint32_t threads, const Draw& draw,
                      const std::function<void(const Progress&)>& progress) {
  const Window window = settings.window();
  std::vector<Tile> tiles = make_tiles(settings);
  Film film(size_t{settings.width} * settings.height);
  const bool adaptive = settings.adaptive_batch > 0;
  const uint32_t batch = adaptive ? settings.adaptive_batch : settings.spp;
  run_workers(
      threads, tiles.size(),
      [&](size_t item, uint32_t worker) {
        uint64_t rays = 0;
        std::vector<uint32_t>& pixels = tiles[item].pixels;  // that have not converged
        for (const uint32_t pixel : pixels) film.sums[pixel] = {};
        for (uint32_t done = 0; done < settings.spp && !pixels.empty();) {
          const uint32_t count = std::min(batch, settings.spp - done);
          rays += draw(pixels, done, count, film.sums.data(), worker);
          done += count;
          for (const uint32_t pixel : pixels) film.samples[pixel] = done;
          if (!adaptive) break;
          std::erase_if(pixels, [&](uint32_t pixel) {
            return has_converged(film.sums[pixel], done, settings.adaptive_tolerance);
          });
        }
        return rays;
      },
      progress);

  size_t noisy = 0, all = size_t{window.width} * window.height;
  if (adaptive) {
    for (const Tile& tile : tiles) noisy += tile.pixels.size();
  }
  return {develop(film, settings.width, window), sample_counts(film, settings.width, window),
          1 - static_cast<double>(noisy) / static_cast<double>(all)};
}

// --noise. A round's pixels are dealt out in portions of some waves.
Exposure expose_to_noise(const Settings& settings, uint32_t threads, const Draw& draw,
                         const std::function<void(const Progress&)>& progress) {
  struct Portion {
    uint32_t half;
    std::vector<uint32_t> pixels;
  };
  constexpr uint32_t kWaves = 4;  // enough that waves are full, few enough that threads end together
  NoiseFilm film(settings.width, settings.height, settings.window(), settings.noise, settings.spp);
  Progress before;
  while (film.count() > 0) {
    const uint32_t size = std::max(1u, kWaves * settings.wave / film.count());
    std::vector<Portion> portions;
    double drawing = 0;
    for (uint32_t half = 0; half < NoiseFilm::kHalves; ++half) {
      const std::vector<uint32_t> pixels = film.drawing(half);
      drawing += static_cast<double>(pixels.size()) * film.count();
      for (auto begin = pixels.begin(); begin != pixels.end();) {
        const auto end = begin + std::min<ptrdiff_t>(size, pixels.end() - begin);
        portions.push_back({half, {begin, end}});
        begin = end;
      }
    }
    Progress now = before;
    run_workers(
        threads, portions.size(),
        [&](size_t item, uint32_t worker) {
          const Portion& portion = portions[item];
          return draw(portion.pixels, film.first(portion.half), film.count(), film.sums(portion.half), worker);
        },
        [&](const Progress& round) {
          now = {(film.drawn() + round.fraction * drawing) / film.expected(), before.rays + round.rays,
                 before.seconds + round.seconds};
          if (progress) progress(now);
        });
    before = now;
    film.end_round();
  }
  return {film.develop(), film.sample_counts(), film.converged()};
}

}  // namespace

Exposure expose(const Settings& settings, uint32_t threads, const Draw& draw,
                const std::function<void(const Progress&)>& progress) {
  return (settings.noise > 0 ? expose_to_noise : expose_tiles)(settings, threads, draw, progress);
}

}  // namespace lanewise
