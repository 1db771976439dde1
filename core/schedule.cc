#include "core/schedule.h"

#include <algorithm>
#include <chrono>

#include "core/film.h"
#include "core/noise_film.h"
#include "core/rounds.h"
#include "core/tile.h"
#include "core/workers.h"

namespace lanewise {
namespace {

// -a. Of a tile's pixels, batch after batch goes to those that have not converged.
Exposure expose_adaptively(const Settings& settings, uint32_t threads, const Draw& draw,
                           const std::function<void(const Progress&)>& progress) {
  const Window window = settings.window();
  std::vector<Tile> tiles = make_tiles(settings, settings.adaptive_batch);
  Film film(size_t{settings.width} * settings.height);
  run_workers(
      threads, tiles.size(),
      [&](size_t item, uint32_t worker) {
        uint64_t rays = 0;
        std::vector<uint32_t>& pixels = tiles[item].pixels;  // that have not converged
        for (const uint32_t pixel : pixels) film.sums[pixel] = {};
        for (uint32_t done = 0; done < settings.spp && !pixels.empty();) {
          const uint32_t count = std::min(settings.adaptive_batch, settings.spp - done);
          rays += draw(pixels, done, count, film.sums.data(), worker);
          done += count;
          for (const uint32_t pixel : pixels) film.samples[pixel] = done;
          std::erase_if(pixels, [&](uint32_t pixel) {
            return has_converged(film.sums[pixel], done, settings.adaptive_tolerance);
          });
        }
        return rays;
      },
      progress);

  size_t noisy = 0, all = size_t{window.width} * window.height;
  for (const Tile& tile : tiles) noisy += tile.pixels.size();
  return {develop(film, settings.width, window),
          sample_counts(film, settings.width, window),
          1 - static_cast<double>(noisy) / static_cast<double>(all),
          {}};
}

// --noise. A round's pixels are dealt out in portions of some waves. Where there is a time, rounds are shortened to it.
Exposure expose_to_noise(const Settings& settings, uint32_t threads, const Draw& draw,
                         const std::function<void(const Progress&)>& progress, const Clock& clock) {
  struct Portion {
    uint32_t half;
    std::vector<uint32_t> pixels;
  };
  constexpr uint32_t kWaves = 4;  // enough that waves are full, few enough that threads end together
  NoiseFilm film(settings.width, settings.height, settings.window(), settings.noise, settings.spp);
  const double start = clock();
  std::optional<ErrorEstimate> error;
  const auto estimate = [&] {
    if (settings.estimate_error) error = film.estimate_error(threads);
  };
  double seconds_per_sample = 0;  // of all pixels that are still drawn
  double drawn = 0;               // in the round before
  uint64_t rays = 0;
  while (film.count() > 0) {
    const std::vector<uint32_t> drawing[] = {film.drawing(0), film.drawing(1)};
    const auto pixels = static_cast<double>(drawing[0].size() + drawing[1].size());
    if (settings.seconds > 0 && drawn > 0) {
      const double left = settings.seconds - (clock() - start);
      const double fits = std::max(0.0, left / (seconds_per_sample * pixels));
      if (fits < film.count()) film.shorten(static_cast<uint32_t>(0.9 * fits));
    }
    const uint32_t count = film.count();
    const size_t size = std::max(1u, kWaves * settings.wave / std::max(count, 1u));
    std::vector<Portion> portions;
    for (uint32_t half = 0; half < NoiseFilm::kHalves && count > 0; ++half) {
      const std::vector<uint32_t>& all = drawing[half];
      for (size_t begin = 0; begin < all.size(); begin += size) {
        const auto first = all.begin() + static_cast<ptrdiff_t>(begin);
        portions.push_back({half, {first, first + static_cast<ptrdiff_t>(std::min(size, all.size() - begin))}});
      }
    }
    const double begin = clock();
    const uint64_t rays_before = rays;
    run_workers(
        threads, portions.size(),
        [&](size_t item, uint32_t worker) {
          const Portion& portion = portions[item];
          return draw(portion.pixels, film.first(portion.half), count, film.sums(portion.half), worker);
        },
        [&](const Progress& round) {
          rays = rays_before + round.rays;
          const double seconds = clock() - start;
          // The first round alone tells how many there will be.
          const double fraction = drawn > 0 ? (film.drawn() + round.fraction * pixels * count) / film.expected() : 0;
          if (progress) {
            progress({std::max(fraction, settings.seconds > 0 ? seconds / settings.seconds : 0), rays, seconds,
                      error ? error->mrse : -1});
          }
        });
    drawn = pixels * count;
    if (count > 0) seconds_per_sample = (clock() - begin) / drawn;
    film.end_round();
    if (progress || film.count() == 0) estimate();
  }
  return {film.develop(), film.sample_counts(), film.converged(), error};
}

}  // namespace

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Exposure expose(const Settings& settings, uint32_t threads, const Draw& draw,
                const std::function<void(const Progress&)>& progress, const Clock& clock) {
  if (settings.noise > 0) return expose_to_noise(settings, threads, draw, progress, clock);
  if (settings.adaptive_batch > 0) return expose_adaptively(settings, threads, draw, progress);
  return expose_in_rounds(settings, threads, draw, progress, clock);
}

}  // namespace lanewise
