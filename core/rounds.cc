#include "core/rounds.h"

#include <algorithm>
#include <atomic>

#include "core/error_estimate.h"
#include "core/film.h"
#include "core/probes.h"
#include "core/tile.h"
#include "core/workers.h"

namespace lanewise {
namespace {

class Rounds {
 public:
  Rounds(const Settings& settings, uint32_t threads, const Draw& draw,
         const std::function<void(const Progress&)>& progress, const Clock& clock)
      : settings_(settings),
        threads_(threads),
        draw_(draw),
        progress_(progress),
        clock_(clock),
        start_(clock()),
        film_(size_t{settings.width} * settings.height),
        probes_(settings, settings.estimate_error && settings.spp <= Probes::kMostSamples) {}

  Exposure expose() {
    while (const uint32_t count = next_round()) {
      const double begin = clock_();
      const bool whole = draw_tiles(count);
      done_ += count;
      if (!whole || (timed() && drawing_time_left() <= 0)) break;
      draw_probes(count);
      seconds_per_sample_ = (clock_() - begin) / count;
      if (done_ < settings_.spp && (progress_ || timed())) close();
    }
    return close();
  }

 private:
  bool timed() const { return settings_.seconds > 0; }
  double elapsed() const { return clock_() - start_; }
  double drawing_time_left() const { return settings_.seconds - closing_ - elapsed(); }

  // 0: none.
  uint32_t next_round() const {
    constexpr uint32_t kFirst = 64;  // samples before there is an error to show
    const uint32_t left = settings_.spp - done_;
    if (done_ == 0) return timed() ? 1 : probes_.pixels().empty() ? left : std::min(kFirst, left);
    if (!timed()) return std::min(done_, left);
    const double time_left = drawing_time_left();
    return time_left > 0 ? timed_round(done_, settings_.spp, time_left / seconds_per_sample_) : 0;
  }

  // False if time was up before all were drawn. The first sample is drawn whatever the time.
  bool draw_tiles(uint32_t count) {
    const std::vector<Tile> tiles = make_tiles(settings_, count);
    std::atomic<bool> whole{true};
    const uint64_t rays_before = rays_;
    run_workers(
        threads_, tiles.size(),
        [&](size_t item, uint32_t worker) -> uint64_t {
          const std::vector<uint32_t>& pixels = tiles[item].pixels;
          if (done_ == 0) {
            for (const uint32_t pixel : pixels) film_.sums[pixel] = {};
          } else if (timed() && drawing_time_left() <= 0) {
            whole = false;
            return 0;
          }
          const uint64_t rays = draw_(pixels, done_, count, film_.sums.data(), worker);
          for (const uint32_t pixel : pixels) film_.samples[pixel] = done_ + count;
          return rays;
        },
        [&](const Progress& round) {
          rays_ = rays_before + round.rays;
          report(done_ + round.fraction * count);
        });
    return whole;
  }

  void draw_probes(uint32_t count) {
    constexpr uint32_t kWaves = 4;  // enough that waves are full
    const size_t all = probes_.pixels().size(), portion = std::max(1u, kWaves * settings_.wave / count);
    if (all == 0) return;
    std::atomic<uint64_t> rays{0};
    run_workers(
        threads_, (all + portion - 1) / portion,
        [&](size_t item, uint32_t worker) {
          const size_t begin = item * portion, end = std::min(begin + portion, all);
          const auto first = probes_.pixels().begin();
          const std::vector<uint32_t> pixels(first + static_cast<ptrdiff_t>(begin),
                                             first + static_cast<ptrdiff_t>(end));
          probes_.exchange(film_, begin, end);
          rays += draw_(pixels, probes_.next_sample(), count, film_.sums.data(), worker);
          probes_.exchange(film_, begin, end);
          return uint64_t{0};
        },
        nullptr);
    probes_.drew(count);
    rays_ += rays;
  }

  // The picture as it is.
  Exposure close() {
    const double begin = clock_();
    const Window window = settings_.window();
    if (probes_.samples() > 1) {
      error_ = estimate_error(mean_picture(film_, settings_.width, window), probes_, threads_);
    }
    Exposure exposure{develop(film_, settings_.width, window), sample_counts(film_, settings_.width, window), 1,
                      error_};
    closing_ = clock_() - begin;
    report(done_);
    return exposure;
  }

  void report(double samples) const {
    if (!progress_) return;
    const double fraction = std::max(samples / settings_.spp, timed() ? elapsed() / settings_.seconds : 0);
    progress_({fraction, rays_, elapsed(), error_ ? error_->mrse : -1});
  }

  const Settings& settings_;
  uint32_t threads_;
  const Draw& draw_;
  const std::function<void(const Progress&)>& progress_;
  const Clock& clock_;
  double start_;
  double closing_ = 0;  // seconds that close() takes, to be kept for the last one
  double seconds_per_sample_ = 0;
  uint32_t done_ = 0;  // samples of each pixel
  uint64_t rays_ = 0;
  Film film_;
  Probes probes_;
  std::optional<ErrorEstimate> error_;
};

}  // namespace

uint32_t timed_round(uint32_t done, uint32_t most, double fits) {
  const uint32_t longest = std::min(done, most - done);
  return fits * 0.9 >= longest ? longest : std::max(1u, static_cast<uint32_t>(0.9 * fits));
}

Exposure expose_in_rounds(const Settings& settings, uint32_t threads, const Draw& draw,
                          const std::function<void(const Progress&)>& progress, const Clock& clock) {
  return Rounds(settings, threads, draw, progress, clock).expose();
}

}  // namespace lanewise
