#include "core/rounds.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "core/dimensions.h"
#include "core/error_estimate.h"
#include "core/film.h"
#include "core/pieces.h"
#include "core/probes.h"
#include "core/sample_shares.h"
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
        shares_(shares()),
        probes_(settings, shares_, settings.estimate_error, side) {
    if (light_) light_film_.emplace(film_.sums.size());
    if (timed()) for_each_pixel([&](uint32_t i) { paths_per_sample_ += shares_.mean_count(i); });
    if (!control.resume) return;
    control.resume->get_picture(settings, shares_, film_);
    if (light_) resume_light(*control.resume);
    done_ = whole_samples();
    probes_.load(*control.resume, done_);
  }

  Exposure expose() {
    draw_probes();
    while (const uint32_t count = next_round()) {
      const double begin = intervals_.elapsed();
      const double paths = paths_left(done_ + count);
      const bool whole = draw_light(done_ + count) && draw_tiles(done_ + count);
      if (whole) done_ += count;
      if (!whole || intervals_.stopped() || (timed() && drawing_time_left() <= 0)) break;
      draw_probes();
      if (paths > 0) seconds_per_path_ = (intervals_.elapsed() - begin) / paths;
      // To show its error; and under --time, to know how long that takes: but for the last one's time.
      const bool last = done_ >= settings_.spp || (timed() && drawing_time_left() <= closing_);
      if (!last && (control_.progress || timed())) close();
    }
    Exposure exposure = close();
    intervals_.save([&] { return state(); });
    return exposure;
  }

 private:
  void resume_light(const SavedRender& saved) {
    Film& film = light_film_->film();
    saved.get_film("light", settings_.width, film);
    const ZeroedVector<uint64_t> passes = sample_counts(film, settings_.width, settings_.window());
    bool can_be = passes[0] <= settings_.spp;
    for (const uint64_t n : passes) can_be &= n == passes[0];
    // They are drawn before the samples that they go with; but for the first, by which there are shares.
    for_each_pixel([&](uint32_t i) {
      const bool is_first = settings_.allocation == Allocation::kNoise && film_.samples[i] == 1;
      can_be &= is_first || film_.samples[i] <= shares_.count(i, passes[0]);
    });
    saved.check(can_be, "damaged: its passes of light paths cannot be");
    std::ranges::fill(film.samples, passes[0]);
  }

  // Those that the samples so far have. If there are none, by the first of every pixel, where that is asked for.
  SampleShares shares() {
    const SampleShares same(settings_.first_sample);
    if (settings_.allocation == Allocation::kEven) return same;
    if (const SavedRender* saved = control_.resume) {
      saved->check_area(settings_.window());
      bool begun = false;
      saved->get<uint64_t>("picture.samples", settings_.width, [&](size_t, uint64_t n) { begun |= n > 0; });
      if (begun) {
        const auto had = SampleShares::saved(settings_.first_sample, settings_.width, settings_.height, *saved);
        saved->check(had.has_value(), "damaged: its shares of samples cannot be");
        return *had;
      }
    }
    // Of the whole picture, so that a part of it has the same shares; unless they hang on the clock already.
    Settings all = settings_;
    if (!timed()) all.crop = {};
    if (!draw_first(all)) return same;
    if (settings_.first_sample == 0) for_each_pixel([&](uint32_t i) { film_.samples[i] = 1; });
    return {settings_.first_sample, settings_.width,   settings_.height,
            all.window(),           film_.sums.data(), thread_count(settings_)};
  }

  // Sample 0 of every pixel. False if the render was stopped before that.
  bool draw_first(const Settings& settings) {
    const std::vector<Tile> tiles = make_tiles(settings, 1);
    run(
        tiles.size(),
        [&](size_t item, uint32_t worker) {
          if (intervals_.stopped()) return uint64_t{0};
          return draw_(tiles[item].pixels, 0, 1, film_.sums.data(), worker);
        },
        [&](const Progress&) { report(0); });
    return !intervals_.stopped();
  }

  // body(item, worker), on all workers: the rays that it took, which are counted.
  template <class Body>
  void run(size_t items, const Body& body, const std::function<void(const Progress&)>& progress) {
    std::atomic<uint64_t> rays{0};
    const auto counted = [&](size_t item, uint32_t worker) {
      const uint64_t took = body(item, worker);
      rays += took;
      return took;
    };
    run_workers(workers_, items, counted, progress);
    rays_ += rays;
  }

  bool timed() const { return settings_.seconds > 0; }
  // Whose last piece, begun at its end, takes a wave of a thread's time.
  double drawing_time_left() const {
    const double last_piece = seconds_per_path_ * workers_ * settings_.wave;
    return settings_.seconds - closing_ - last_piece - intervals_.elapsed();
  }

  // 0: none.
  uint32_t next_round() const {
    constexpr uint64_t kFirst = 64;  // samples before there is an error to show
    const uint64_t left = settings_.spp - std::min(done_, settings_.spp);
    if (done_ == 0) return timed() ? 1 : short_of(probes_.pixels().empty() ? left : std::min(kFirst, left));
    if (!timed()) return short_of(probes_.pixels().empty() ? left : std::min(done_, left));
    const double time_left = drawing_time_left();
    if (left == 0 || time_left <= 0) return 0;
    if (seconds_per_path_ == 0) return 1;
    return short_of(timed_round(done_, settings_.spp, time_left / (seconds_per_path_ * paths_per_sample_)));
  }
  // Light paths are drawn before the tiles of a round, which is not to be so long that one waits for them.
  uint32_t short_of(uint64_t count) const {
    const uint64_t longest = light_ ? light_->passes_at_a_time(workers_) : kLongestRound;
    return static_cast<uint32_t>(std::min({count, longest, uint64_t{kLongestRound}}));
  }

  // f(pixel) for those of the window.
  template <class F>
  void for_each_pixel(const F& f) const {
    const Window window = settings_.window();
    for (uint32_t y = window.y; y < window.y + window.height; ++y) {
      for (uint32_t x = window.x; x < window.x + window.width; ++x) f(y * settings_.width + x);
    }
  }

  // The most samples that all pixels have their shares of, and light paths as many passes.
  uint64_t whole_samples() const {
    uint64_t least = light_ ? light_film_->passes() : settings_.spp;
    for_each_pixel([&](uint32_t i) { least = std::min(least, shares_.samples_for(i, film_.samples[i])); });
    return least;
  }

  // None has more than that, nor have light paths.
  bool is_whole(uint64_t samples) const {
    bool whole = !light_ || light_film_->passes() == samples;
    for_each_pixel([&](uint32_t i) { whole &= film_.samples[i] == shares_.count(i, samples); });
    return whole;
  }

  // Of any pixel.
  uint64_t least_samples() const {
    uint64_t least = kMaxSpp;
    for_each_pixel([&](uint32_t i) { least = std::min(least, film_.samples[i]); });
    return least;
  }

  // Tiles, or groups of one share near each other, of the pixels that have less than their shares of that, all of a tile with as many
  // samples and as many to come. They are of a wave or little less, if that leaves work for all workers.
  std::vector<Tile> tiles_behind(uint64_t samples) const {
    constexpr double kPerWorker = 16;
    const double enough = std::min<double>(settings_.wave, paths_left(samples) / (kPerWorker * workers_));
    std::vector<Tile> behind;
    std::map<std::array<uint64_t, 3>, Tile> parts;  // by the number of their first sample, samples drawn, and to come
    for (const Tile& tile : make_tiles(settings_, static_cast<uint32_t>(samples - done_), !shares_.even())) {
      for (auto begin = tile.pixels.begin(); begin != tile.pixels.end();) {
        const size_t group = shares_.group(*begin);
        const uint64_t drawn = film_.samples[*begin], due = shares_.count(*begin, samples);
        const auto end = std::find_if(begin, tile.pixels.end(), [&](uint32_t pixel) {
          return film_.samples[pixel] != drawn || shares_.group(pixel) != group;
        });
        if (due > drawn) {
          std::vector<uint32_t>& part = parts[{shares_.first(*begin), drawn, due - drawn}].pixels;
          const auto together = static_cast<double>(part.size() + static_cast<size_t>(end - begin));
          if (!part.empty() && together * static_cast<double>(due - drawn) > enough)
            behind.push_back({std::exchange(part, {})});
          part.insert(part.end(), begin, end);
        }
        begin = end;
      }
    }
    for (auto& [counts, part] : parts) behind.push_back(std::move(part));
    return behind;
  }
  // Of all pixels, to that many samples each on average.
  double paths_left(uint64_t samples) const {
    const Window window = settings_.window();
    uint64_t drawn = 0;
    for_each_pixel([&](uint32_t i) { drawn += film_.samples[i]; });
    return std::max(0.0, static_cast<double>(samples) * window.width * window.height - static_cast<double>(drawn));
  }

  // Brings every pixel to its share of that many samples. False if time was up, or the render was stopped, before that. The first
  // sample is drawn whatever the time.
  bool draw_tiles(uint64_t samples) {
    const auto count = static_cast<double>(samples - done_);
    const auto time_is_up = [&] { return timed() && drawing_time_left() <= 0; };
    return draw_pieces(
        workers_, intervals_, rays_, [&] { return tiles_behind(samples); },
        [&](const Tile& tile, uint32_t worker, uint64_t& rays) {
          const uint32_t any = tile.pixels[0];
          const uint64_t first = film_.samples[any], due = shares_.count(any, samples);
          if (first > 0 && time_is_up()) return false;
          if (first == 0) {
            for (const uint32_t pixel : tile.pixels) film_.sums[pixel] = {};
          }
          rays += draw_(tile.pixels, shares_.first(any) + first, static_cast<uint32_t>(due - first), film_.sums.data(),
                        worker);
          for (const uint32_t pixel : tile.pixels) film_.samples[pixel] = due;
          return true;
        },
        [&](double share) { report(static_cast<double>(done_) + share * count); }, [&] { return state(); },
        [&] { return time_is_up() && least_samples() > 0; });
  }

  // Brings the light paths to that many passes. False if time was up, or the render was stopped, before that.
  bool draw_light(uint64_t passes) {
    while (light_ && light_film_->passes() < passes) {
      if (intervals_.stopped() || (done_ > 0 && timed() && drawing_time_left() <= 0)) return false;
      const uint64_t first = settings_.first_sample + light_film_->passes(), left = passes - light_film_->passes();
      const uint64_t some = std::min(left, light_->passes_at_a_time(workers_));
      const std::vector<LightPiece> pieces = light_->pieces(first, some, workers_);
      run(
          pieces.size(), [&](size_t item, uint32_t worker) { return light_->draw(pieces[item], *light_film_, worker); },
          [&](const Progress&) { report(static_cast<double>(done_)); });
      light_film_->drew(some);
      intervals_.drew();
      if (intervals_.save_due()) intervals_.save([&] { return state(); });
    }
    return true;
  }

  // Brings them to the samples that the picture has, if there is time for that.
  void draw_probes() {
    if (probes_.pixels().empty() || probes_.samples() >= done_) return;
    const auto behind = static_cast<double>(done_ - probes_.samples());
    if (timed() && drawing_time_left() < behind * seconds_per_probe_sample_) return;
    const double begin = intervals_.elapsed();
    while (probes_.samples() < done_) draw_some_probes();
    seconds_per_probe_sample_ = (intervals_.elapsed() - begin) / behind;
  }

  void draw_some_probes() {
    constexpr uint32_t kWaves = 4;  // enough that waves are full
    const uint32_t count = short_of(done_ - probes_.samples());
    const size_t all = probes_.pixels().size();
    std::vector<size_t> cuts = {0};
    while (cuts.back() < all) {
      const uint32_t more = probes_behind(cuts.back(), count);
      cuts.push_back(probes_.end_of_portion(cuts.back(), std::max(1u, kWaves * settings_.wave / std::max(more, 1u))));
    }
    run(
        cuts.size() - 1,
        [&](size_t item, uint32_t worker) {
          const size_t begin = cuts[item], end = cuts[item + 1];
          const uint32_t more = probes_behind(begin, count);
          if (more == 0) return uint64_t{0};
          const auto first = probes_.pixels().begin();
          const std::vector<uint32_t> pixels(first + static_cast<ptrdiff_t>(begin),
                                             first + static_cast<ptrdiff_t>(end));
          probes_.exchange(film_, begin, end);
          const uint64_t rays = draw_(pixels, probes_.next_sample(begin), more, film_.sums.data(), worker);
          probes_.exchange(film_, begin, end);
          return rays;
        },
        nullptr);
    probes_.drew(count);
  }

  // Samples of a probe, if the picture gets so many more.
  uint32_t probes_behind(size_t probe, uint32_t count) const {
    const uint64_t due = shares_.count(probes_.pixels()[probe], probes_.samples() + count);
    return static_cast<uint32_t>(due - probes_.drawn(probe));
  }

  SavedRender state() const {
    SavedRender saved;
    saved.area = settings_.window();
    saved.put_film("picture", settings_.width, film_);
    if (light_film_) saved.put_film("light", settings_.width, light_film_->film());
    probes_.save(saved);
    if (settings_.allocation == Allocation::kNoise) shares_.save(saved, settings_.width);
    if (const uint64_t whole = whole_samples(); whole > 0 && is_whole(whole)) saved.numbers[kWholeSamples] = whole;
    return saved;
  }

  // The picture as it is.
  Exposure close() {
    const double begin = intervals_.elapsed();
    const Window window = settings_.window();
    const uint32_t threads = thread_count(settings_);
    const Film* light = light_film_ ? &light_film_->film() : nullptr;
    if (probes_.least_drawn() > 1 && least_samples() > 1) {
      std::optional<MeanPicture> by_light;
      if (light) by_light = light_picture(*light, settings_.width, window, threads);
      error_ = estimate_error(mean_picture(film_, settings_.width, window, side_, threads),
                              by_light ? &*by_light : nullptr, probes_, threads);
    }
    Exposure exposure{.image = develop(film_, settings_.width, window, light, threads),
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
  double closing_ = 0;                   // seconds that close() takes, to be kept for the last one
  double seconds_per_path_ = 0;          // of the picture, in the last round; 0: there was none yet
  double seconds_per_probe_sample_ = 0;  // of all probes, the last time
  double paths_per_sample_ = 0;          // of the whole window, on average
  uint64_t done_ = 0;                    // samples that every pixel has its share of
  uint64_t rays_ = 0;
  Film film_;
  LightPathDraw* light_;
  std::optional<LightFilm> light_film_;
  uint32_t side_;  // of squares of pixels
  std::optional<ErrorEstimate> error_;
  SampleShares shares_;
  Probes probes_;
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
