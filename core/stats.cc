#include "core/stats.h"

#include <algorithm>
#include <numeric>
#include <thread>
#include <utility>

namespace lanewise {

namespace {

RenderStats make_stats(const Profile& profile) {
  RenderStats stats;
  stats.samples = stats.camera_rays = profile.samples;
  stats.light_paths = profile.light_paths;
  stats.bounce_rays = profile.bounce_rays;
  stats.shadow_rays = profile.shadow_rays;
  stats.invalid_samples = profile.invalid_samples;
  stats.paths_by_length = profile.paths_by_length;
  for (int i = 0; i < kStageCount; ++i) {
    const StageCounter c = profile.total(static_cast<Stage>(i));
    if (c.calls == 0) continue;
    stats.stages.push_back({kStageNames[i], c.calls, c.paths, static_cast<double>(c.nanoseconds) * 1e-9,
                            static_cast<double>(c.paths) / static_cast<double>(c.lanes)});
  }
  return stats;
}

}  // namespace

uint32_t thread_count(const Settings& settings) {
  return settings.threads > 0 ? settings.threads : std::max(1u, std::thread::hardware_concurrency());
}

RenderControl count_invalid(const RenderControl& control, std::function<uint64_t()> count) {
  RenderControl counting = control;
  if (!control.save) return counting;
  counting.save = [&control, count = std::move(count)](SavedRender&& saved) {
    saved.invalid_samples = count() + (control.resume ? control.resume->invalid_samples : 0);
    control.save(std::move(saved));
  };
  return counting;
}

RenderResult make_result(Exposure exposure, const std::vector<Profile>& profiles, const SavedRender* resumed,
                         std::chrono::duration<double> elapsed) {
  Profile all;
  uint32_t threads = 0;
  for (const Profile& profile : profiles) {
    all.add(profile);
    threads += profile.samples + profile.light_paths > 0;
  }
  RenderResult result{std::move(exposure.image), std::move(exposure.samples), make_stats(all), std::move(all), {}};
  const double drawn = std::accumulate(result.samples.begin(), result.samples.end(), 0.0);
  result.stats.samples_per_pixel = drawn / static_cast<double>(result.samples.size());
  if (resumed) result.stats.invalid_samples += resumed->invalid_samples;
  result.stats.stopped = exposure.stopped;
  result.stats.converged = exposure.converged;
  result.stats.error = exposure.error;
  result.stats.threads = threads;
  result.stats.seconds = elapsed.count();
  return result;
}

}  // namespace lanewise
