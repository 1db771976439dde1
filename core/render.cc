#include "core/render.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>

#include "core/film.h"
#include "core/stats.h"
#include "core/tile.h"
#include "core/wave.h"
#include "core/workers.h"

namespace lanewise {
namespace {

// Adds samples [first, first + samples) of all the pixels to the film, wave by wave.
void run_batches(Wave& wave, const std::vector<uint32_t>& pixels, uint32_t first, uint32_t samples, Film& film) {
  Batch batch{.pixels = pixels.data(), .samples = samples, .first_sample = first};
  const uint64_t total = uint64_t{samples} * pixels.size();
  for (; batch.first_path < total; batch.first_path += batch.paths) {
    batch.paths = static_cast<uint32_t>(std::min<uint64_t>(wave.size(), total - batch.first_path));
    wave.run(batch, film.sums.data());
  }
  for (const uint32_t pixel : pixels) film.samples[pixel] += samples;
}

// -a: batch after batch for the pixels that have not converged.
void run_adaptive(Wave& wave, std::vector<uint32_t> pixels, const Settings& settings, Film& film) {
  for (uint32_t done = 0; done < settings.spp && !pixels.empty();) {
    const uint32_t samples = std::min(settings.adaptive_batch, settings.spp - done);
    run_batches(wave, pixels, done, samples, film);
    done += samples;
    std::erase_if(pixels, [&](uint32_t pixel) {
      return has_converged(film.sums[pixel], film.samples[pixel], settings.adaptive_tolerance);
    });
  }
}

}  // namespace

RenderResult render(const Plan& plan, const std::function<void(const Progress&)>& progress) {
  const auto start = std::chrono::steady_clock::now();
  const Settings& settings = plan.settings;
  const std::vector<Tile> tiles = make_tiles(settings);
  const uint32_t threads = thread_count(settings, tiles.size());
  Film film(size_t{settings.width} * settings.height);
  std::vector<std::unique_ptr<Wave>> waves(threads);

  run_workers(
      threads, tiles.size(),
      [&](size_t item, uint32_t worker) {
        std::unique_ptr<Wave>& wave = waves[worker];
        if (!wave) wave = std::make_unique<Wave>(plan, settings.wave);  // by its own thread, so that its memory is near
        const uint64_t before = wave->profile().rays();
        if (settings.adaptive_batch > 0) {
          run_adaptive(*wave, tiles[item].pixels, settings, film);
        } else {
          run_batches(*wave, tiles[item].pixels, 0, settings.spp, film);
        }
        return wave->profile().rays() - before;
      },
      progress);

  Profile profile;
  for (const std::unique_ptr<Wave>& wave : waves) {
    if (wave) profile.add(wave->profile());
  }
  const Window window = settings.window();
  RenderResult result{develop(film, settings.width, window), sample_counts(film, settings.width, window),
                      make_stats(profile)};
  result.stats.threads = threads;
  result.stats.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace lanewise
