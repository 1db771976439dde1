#include "core/rounds.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>

#include "core/error_estimate.h"
#include "core/film.h"
#include "core/pieces.h"
#include "core/probes.h"
#include "core/stats.h"
#include "core/tile.h"
#include "core/workers.h"

namespace lanewise {
namespace {

class Rounds {
 public:
  Rounds(const Settings& settings, uint32_t workers, const Draw& draw, const RenderControl& control,
         LightPathDraw* light, uint32_t side)
      : settings_(settings),
        workers_(workers),
        draw_(draw),
        control_(control),
        intervals_(control),
        film_(size_t{settings.width} * settings.height),
        light_(light),
        side_(side),
        probes_(settings, settings.estimate_error, side) {
    if (light_) light_film_.emplace(film_.sums.size());
    if (!control.resume) return;
    control.resume->get_picture(settings, film_);
    if (light_) resume_light(*control.resume);
    probes_.load(*control.resume);
    done_ = least_samples();
    control.resume->check(probes_.samples() <= done_, "damaged: more probes than samples");
  }

  Exposure expose() {
    draw_probes();
    while (const uint32_t count = next_round()) {
      const double begin = intervals_.elapsed();
      const bool whole = draw_light(done_ + count) && draw_tiles(done_ + count);
      if (whole) done_ += count;
      if (!whole || intervals_.stopped() || (timed() && drawing_time_left() <= 0)) break;
      draw_probes();
      seconds_per_sample_ = (intervals_.elapsed() - begin) / count;
      if (done_ < settings_.spp && (control_.progress || timed())) close();
    }
    Exposure exposure = close();
    intervals_.save([&] { return state(); });
    return exposure;
  }

 private:
  void resume_light(const SavedRender& saved) {
    Film& film = light_film_->film();
    saved.get_film("light", settings_.width, film);
    const std::vector<uint64_t> passes = sample_counts(film, settings_.width, settings_.window());
    const bool even = std::ranges::all_of(passes, [&](uint64_t n) { return n == passes[0]; });
    saved.check(even && passes[0] <= settings_.spp && passes[0] >= least_samples(),
                "damaged: its passes of light paths cannot be");
    std::ranges::fill(film.samples, passes[0]);
  }

  bool timed() const { return settings_.seconds > 0; }
  double drawing_time_left() const { return settings_.seconds - closing_ - intervals_.elapsed(); }

  // 0: none.
  uint32_t next_round() const {
    constexpr uint64_t kFirst = 64;  // samples before there is an error to show
    const uint64_t left = settings_.spp - std::min(done_, settings_.spp);
    if (done_ == 0) return timed() ? 1 : short_of(probes_.pixels().empty() ? left : std::min(kFirst, left));
    if (!timed()) return short_of(probes_.pixels().empty() ? left : std::min(done_, left));
    const double time_left = drawing_time_left();
    if (left == 0 || time_left <= 0) return 0;
    return seconds_per_sample_ > 0 ? short_of(timed_round(done_, settings_.spp, time_left / seconds_per_sample_)) : 1;
  }
  // Light paths are drawn before the tiles of a round, which is not to be so long that one waits for them.
  uint32_t short_of(uint64_t count) const {
    const uint64_t longest = light_ ? light_->passes_at_a_time(workers_) : kLongestRound;
    return static_cast<uint32_t>(std::min({count, longest, uint64_t{kLongestRound}}));
  }

  // Of the window's pixels.
  uint64_t least_samples() const {
    const std::vector<uint64_t> counts = sample_counts(film_, settings_.width, settings_.window());
    return *std::min_element(counts.begin(), counts.end());
  }

  // Tiles of the pixels that have fewer samples than that, each of pixels with the same number of them.
  std::vector<Tile> tiles_behind(uint64_t samples) const {
    std::vector<Tile> behind;
    for (const Tile& tile : make_tiles(settings_, static_cast<uint32_t>(samples - done_))) {
      std::map<uint64_t, Tile> by_samples;
      for (const uint32_t pixel : tile.pixels) {
        if (film_.samples[pixel] < samples) by_samples[film_.samples[pixel]].pixels.push_back(pixel);
      }
      for (auto& [drawn, part] : by_samples) behind.push_back(std::move(part));
    }
    return behind;
  }

  // Brings every pixel to that many samples. False if time was up, or the render was stopped, before that. The first sample is
  // drawn whatever the time.
  bool draw_tiles(uint64_t samples) {
    const auto count = static_cast<double>(samples - done_);
    const auto time_is_up = [&] { return timed() && drawing_time_left() <= 0; };
    return draw_pieces(
        workers_, intervals_, rays_, [&] { return tiles_behind(samples); },
        [&](const Tile& tile, uint32_t worker, uint64_t& rays) {
          const uint64_t first = film_.samples[tile.pixels[0]];
          if (first > 0 && time_is_up()) return false;
          if (first == 0) {
            for (const uint32_t pixel : tile.pixels) film_.sums[pixel] = {};
          }
          rays += draw_(tile.pixels, settings_.first_sample + first, static_cast<uint32_t>(samples - first),
                        film_.sums.data(), worker);
          for (const uint32_t pixel : tile.pixels) film_.samples[pixel] = samples;
          return true;
        },
        [&](double share) { report(static_cast<double>(done_) + share * count); }, [&] { return state(); },
        [&] { return done_ > 0 && time_is_up(); });
  }

  // Brings the light paths to that many passes. False if time was up, or the render was stopped, before that.
  bool draw_light(uint64_t passes) {
    while (light_ && light_film_->passes() < passes) {
      if (intervals_.stopped() || (done_ > 0 && timed() && drawing_time_left() <= 0)) return false;
      const uint64_t first = settings_.first_sample + light_film_->passes(), left = passes - light_film_->passes();
      const uint64_t some = std::min(left, light_->passes_at_a_time(workers_));
      const std::vector<LightPiece> pieces = light_->pieces(first, some, workers_);
      std::atomic<uint64_t> rays{0};
      run_workers(
          workers_, pieces.size(),
          [&](size_t item, uint32_t worker) {
            rays += light_->draw(pieces[item], *light_film_, worker);
            return uint64_t{0};
          },
          [&](const Progress&) { report(static_cast<double>(done_)); });
      rays_ += rays;
      light_film_->drew(some);
      intervals_.drew();
      if (intervals_.save_due()) intervals_.save([&] { return state(); });
    }
    return true;
  }

  // Brings them to the samples that the picture has.
  void draw_probes() {
    while (probes_.samples() < done_ && !probes_.pixels().empty()) draw_some_probes();
  }

  void draw_some_probes() {
    constexpr uint32_t kWaves = 4;  // enough that waves are full
    const uint32_t count = short_of(done_ - probes_.samples());
    const uint32_t square = side_ * side_;
    const size_t all = probes_.pixels().size();
    const size_t portion = square * std::max(1u, kWaves * settings_.wave / (count * square));
    const auto whole_squares = [&](size_t end) {
      while (end < all && probes_.continues(end)) ++end;
      return std::min(end, all);
    };
    std::atomic<uint64_t> rays{0};
    run_workers(
        workers_, (all + portion - 1) / portion,
        [&](size_t item, uint32_t worker) {
          const size_t begin = whole_squares(item * portion), end = whole_squares((item + 1) * portion);
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

  SavedRender state() const {
    SavedRender saved;
    saved.area = settings_.window();
    saved.put_film("picture", settings_.width, film_);
    if (light_film_) saved.put_film("light", settings_.width, light_film_->film());
    probes_.save(saved);
    return saved;
  }

  // The picture as it is.
  Exposure close() {
    const double begin = intervals_.elapsed();
    const Window window = settings_.window();
    if (probes_.samples() > 1) {
      std::optional<MeanPicture> by_light;
      if (light_film_) by_light = light_picture(light_film_->film(), settings_.width, window);
      error_ = estimate_error(mean_picture(film_, settings_.width, window, side_), by_light ? &*by_light : nullptr,
                              probes_, thread_count(settings_));
    }
    Exposure exposure{.image = develop(film_, settings_.width, window, light_film_ ? &light_film_->film() : nullptr),
                      .samples = sample_counts(film_, settings_.width, window),
                      .stopped = intervals_.stopped() && done_ < settings_.spp,
                      .error = error_};
    closing_ = intervals_.elapsed() - begin;
    report(static_cast<double>(done_));
    return exposure;
  }

  void report(double samples) const {
    if (!control_.progress) return;
    const double seconds = intervals_.elapsed();
    const double fraction =
        std::max(samples / static_cast<double>(settings_.spp), timed() ? seconds / settings_.seconds : 0);
    control_.progress({std::min(fraction, 1.0), rays_, seconds, error_ ? error_->mrse : -1});
  }

  const Settings& settings_;
  uint32_t workers_;
  const Draw& draw_;
  const RenderControl& control_;
  Intervals intervals_;
  double closing_ = 0;             // seconds that close() takes, to be kept for the last one
  double seconds_per_sample_ = 0;  // of each pixel, in the last round; 0: there was none yet
  uint64_t done_ = 0;              // samples that every pixel has
  uint64_t rays_ = 0;
  Film film_;
  LightPathDraw* light_;
  std::optional<LightFilm> light_film_;
  uint32_t side_;  // of squares of pixels
  Probes probes_;
  std::optional<ErrorEstimate> error_;
};

}  // namespace

uint32_t timed_round(uint64_t done, uint64_t most, double fits) {
  const uint64_t longest = std::min({done, most - done, uint64_t{kLongestRound}});
  return static_cast<uint32_t>(std::clamp(std::floor(0.9 * fits), 1.0, static_cast<double>(longest)));
}

Exposure expose_in_rounds(const Settings& settings, uint32_t workers, const Draw& draw, const RenderControl& control,
                          LightPathDraw* light, uint32_t side) {
  return Rounds(settings, workers, draw, control, light, side).expose();
}

}  // namespace lanewise
