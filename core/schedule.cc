#include "core/schedule.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <optional>

#include "core/film.h"
#include "core/noise_film.h"
#include "core/pieces.h"
#include "core/rounds.h"
#include "core/stats.h"
#include "core/tile.h"

namespace lanewise {
namespace {

// -a. Of a tile's pixels, batch after batch goes to those that have not converged.
class Adaptive {
 public:
  Adaptive(const Settings& settings, const Draw& draw, const RenderControl& control)
      : settings_(settings),
        draw_(draw),
        control_(control),
        intervals_(control),
        film_(size_t{settings.width} * settings.height) {
    if (control.resume) control.resume->get_picture(settings, SampleShares(settings.first_sample), film_);
  }

  Exposure expose(uint32_t workers) {
    uint64_t rays = 0;
    const bool finished = draw_pieces(
        workers, intervals_, rays, [&] { return tiles_left(); },
        [&](const Tile& tile, uint32_t worker, uint64_t& tile_rays) { return draw_tile(tile, worker, tile_rays); },
        [&](double share) {
          if (control_.progress) control_.progress({share, rays, intervals_.elapsed()});
        },
        [&] { return state(); }, [] { return false; });

    const Window window = settings_.window();
    const std::vector<Tile> tiles = make_tiles(settings_, settings_.adaptive_batch);
    size_t noisy = 0, all = 0;
    for (const Tile& tile : tiles) {
      noisy += std::ranges::count_if(tile.pixels, [&](uint32_t pixel) { return !converged(pixel); });
      all += tile.pixels.size();
    }
    Exposure exposure{.image = develop(film_, settings_.width, window, nullptr, thread_count(settings_)),
                      .samples = sample_counts(film_, settings_.width, window),
                      .stopped = !finished,
                      .converged = 1 - static_cast<double>(noisy) / static_cast<double>(all),
                      .error = {}};
    intervals_.save([&] { return state(); });
    return exposure;
  }

 private:
  bool converged(uint32_t pixel) const {
    const uint64_t samples = film_.samples[pixel];
    return samples > 0 && has_converged(film_.sums[pixel], samples, settings_.adaptive_tolerance);
  }

  bool finished(uint32_t pixel) const { return film_.samples[pixel] >= settings_.spp || converged(pixel); }

  std::vector<Tile> tiles_left() const {
    std::vector<Tile> tiles = make_tiles(settings_, settings_.adaptive_batch);
    std::erase_if(tiles, [&](const Tile& tile) {
      return std::ranges::all_of(tile.pixels, [&](uint32_t pixel) { return finished(pixel); });
    });
    return tiles;
  }

  // A batch, or less at the end, to those that are furthest behind, until none is left. False if it was not to go on.
  bool draw_tile(const Tile& tile, uint32_t worker, uint64_t& rays) {
    std::vector<uint32_t> left = tile.pixels, pixels;  // not finished; to be drawn now
    for (;;) {
      std::erase_if(left, [&](uint32_t pixel) { return finished(pixel); });
      if (left.empty()) return true;
      if (intervals_.pausing()) return false;
      uint64_t done = settings_.spp;
      for (const uint32_t pixel : left) done = std::min(done, film_.samples[pixel]);
      pixels.clear();
      std::ranges::copy_if(left, std::back_inserter(pixels),
                           [&](uint32_t pixel) { return film_.samples[pixel] == done; });
      if (done == 0) {
        for (const uint32_t pixel : pixels) film_.sums[pixel] = {};
      }
      const auto count = static_cast<uint32_t>(std::min<uint64_t>(settings_.adaptive_batch, settings_.spp - done));
      rays += draw_(pixels, settings_.first_sample + done, count, film_.sums.data(), worker);
      for (const uint32_t pixel : pixels) film_.samples[pixel] = done + count;
      intervals_.drew();
    }
  }

  SavedRender state() const {
    SavedRender saved;
    saved.area = settings_.window();
    saved.put_film("picture", settings_.width, film_);
    return saved;
  }

  const Settings& settings_;
  const Draw& draw_;
  const RenderControl& control_;
  Intervals intervals_;
  Film film_;
};

// --noise. A round's pixels are dealt out in portions of some waves. Where there is a time, rounds are shortened to it.
class ToNoise {
 public:
  ToNoise(const Settings& settings, uint32_t workers, const Draw& draw, const RenderControl& control)
      : settings_(settings),
        workers_(workers),
        draw_(draw),
        control_(control),
        intervals_(control),
        film_(settings.width, settings.height, settings.window(), settings.noise, settings.spp) {
    if (control.resume) film_.load(*control.resume);
  }

  Exposure expose() {
    while (film_.count() > 0) {
      shorten_to_time();
      const double begin = intervals_.elapsed(), drawn = film_.drawn();
      if (!draw_round()) break;
      film_.end_round();
      if (film_.drawn() > drawn) seconds_per_sample_ = (intervals_.elapsed() - begin) / (film_.drawn() - drawn);
      if (control_.progress || film_.count() == 0) estimate();
    }
    Exposure exposure{.image = film_.develop(),
                      .samples = film_.sample_counts(),
                      .stopped = film_.count() > 0,
                      .converged = film_.converged(),
                      .error = error_};
    intervals_.save([&] { return state(); });
    return exposure;
  }

 private:
  struct Portion {
    uint32_t half;
    std::vector<uint32_t> pixels;
  };

  // What the round has yet to draw.
  std::vector<Portion> portions() const {
    constexpr uint32_t kWaves = 4;  // enough that waves are full, few enough that threads end together
    const size_t size = std::max(1u, kWaves * settings_.wave / film_.count());
    std::vector<Portion> portions;
    for (uint32_t half = 0; half < NoiseFilm::kHalves; ++half) {
      const std::vector<uint32_t> all = film_.behind(half);
      for (size_t begin = 0; begin < all.size(); begin += size) {
        const auto first = all.begin() + static_cast<ptrdiff_t>(begin);
        portions.push_back({half, {first, first + static_cast<ptrdiff_t>(std::min(size, all.size() - begin))}});
      }
    }
    return portions;
  }

  // False if the render was stopped before its end.
  bool draw_round() {
    if (film_.count() == 0) return true;
    const double samples = film_.round_pixels() * film_.count();
    return draw_pieces(
        workers_, intervals_, rays_, [&] { return portions(); },
        [&](const Portion& portion, uint32_t worker, uint64_t& rays) {
          rays += draw_(portion.pixels, film_.first(portion.half), film_.count(), film_.sums(portion.half), worker);
          film_.drew(portion.half, portion.pixels);
          return true;
        },
        [&](double share) { report(share * samples); }, [&] { return state(); }, [] { return false; });
  }

  void shorten_to_time() {
    if (settings_.seconds == 0 || seconds_per_sample_ == 0) return;
    const double left = settings_.seconds - intervals_.elapsed();
    const double fits = std::max(0.0, left / (seconds_per_sample_ * film_.round_pixels()));
    if (fits < film_.count()) film_.shorten(static_cast<uint32_t>(0.9 * fits));
  }

  void estimate() {
    if (settings_.estimate_error) error_ = film_.estimate_error(thread_count(settings_));
  }

  // samples: drawn in the round so far.
  void report(double samples) const {
    if (!control_.progress) return;
    const double seconds = intervals_.elapsed();
    // The first round alone tells how many there will be.
    const double drawn = film_.drawn() > 0 ? (film_.drawn() + samples) / film_.expected() : 0;
    const double fraction = std::max(drawn, settings_.seconds > 0 ? seconds / settings_.seconds : 0);
    control_.progress({std::min(fraction, 1.0), rays_, seconds, error_ ? error_->mrse : -1});
  }

  SavedRender state() const {
    SavedRender saved;
    film_.save(saved);
    return saved;
  }

  const Settings& settings_;
  uint32_t workers_;
  const Draw& draw_;
  const RenderControl& control_;
  Intervals intervals_;
  NoiseFilm film_;
  std::optional<ErrorEstimate> error_;
  double seconds_per_sample_ = 0;  // of one pixel, in the last round; 0: there was none yet
  uint64_t rays_ = 0;
};

}  // namespace

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Exposure expose(const Settings& settings, uint32_t workers, const Draw& draw, const RenderControl& control,
                LightPathDraw* light, uint32_t side) {
  if (settings.noise > 0) return ToNoise(settings, workers, draw, control).expose();
  if (settings.adaptive_batch > 0) return Adaptive(settings, draw, control).expose(workers);
  return expose_in_rounds(settings, workers, draw, control, light, side);
}

}  // namespace lanewise
