#include "core/render.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <iterator>

#include "core/local_draw.h"
#include "core/path_reuse.h"
#include "core/remote_ranks.h"
#include "core/schedule.h"
#include "core/stats.h"

namespace lanewise {
namespace {

// On this process's threads, and by other ranks.
class LightPaths : public LightPathDraw {
 public:
  LightPaths(const Plan& plan, LocalDraw& local, RemoteRanks* remote, std::atomic<uint64_t>& invalid)
      : plan_(plan), local_(local), remote_(remote), invalid_(invalid) {}

  std::vector<LightPiece> pieces(uint64_t first, uint64_t passes, uint32_t workers) const override {
    return light_pieces(plan_, first, passes, workers);
  }
  uint64_t passes_at_a_time(uint32_t workers) const override { return lanewise::passes_at_a_time(plan_, workers); }
  uint64_t draw(const LightPiece& piece, LightFilm& film, uint32_t worker) override {
    const uint32_t threads = thread_count(plan_.settings);
    Drawn took;
    if (worker < threads) {
      took = local_.draw_light(piece, worker, [&](Splats& splats) { film.add(splats); });
    } else {
      took = remote_->draw_light(piece, film, worker - threads);
    }
    invalid_ += took.invalid_samples;
    return took.rays;
  }

 private:
  const Plan& plan_;
  LocalDraw& local_;
  RemoteRanks* remote_;
  std::atomic<uint64_t>& invalid_;
};

}  // namespace

RenderResult render(const Plan& plan, const RenderControl& control, ProfileDetail detail) {
  const auto start = std::chrono::steady_clock::now();
  const uint32_t threads = thread_count(plan.settings);
  LocalDraw local(plan, threads, detail);
  std::atomic<uint64_t> invalid{0};
  const auto draw = [&](const std::vector<uint32_t>& pixels, uint64_t first, uint32_t count, PixelSums* sums,
                        uint32_t worker) {
    const Drawn took = worker < threads ? local.draw(pixels, first, count, sums, worker)
                                        : control.remote->draw(pixels, first, count, sums, worker - threads);
    invalid += took.invalid_samples;
    return took.rays;
  };
  LightPaths light(plan, local, control.remote, invalid);
  const RenderControl counting = count_invalid(control, [&] { return invalid.load(); });
  const uint32_t workers = threads + (control.remote ? control.remote->workers() : 0);
  Exposure exposure =
      expose(plan.settings, workers, draw, counting, has_light_paths(plan) ? &light : nullptr, side_together(plan));

  const auto elapsed = std::chrono::steady_clock::now() - start;
  std::vector<Profile> profiles = local.profiles();
  if (control.remote) std::ranges::move(control.remote->profiles(), std::back_inserter(profiles));
  RenderResult result = make_result(std::move(exposure), profiles, control.resume, elapsed);
  result.logs = local.logs();
  if (control.remote) {
    std::vector<RankStats>& ranks = result.stats.ranks;
    ranks.push_back({.threads = threads});
    for (const Profile& profile : local.profiles()) ranks[0].samples += profile.samples;
    std::ranges::move(control.remote->stats(), std::back_inserter(ranks));
    result.stats.threads = 0;
    for (const RankStats& rank : ranks) result.stats.threads += rank.threads;
  }
  return result;
}

}  // namespace lanewise
