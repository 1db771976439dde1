#include "core/stats.h"

#include <algorithm>
#include <thread>

namespace lanewise {

RenderStats make_stats(const Profile& profile) {
  RenderStats stats;
  stats.samples = stats.camera_rays = profile.samples;
  stats.bounce_rays = profile.bounce_rays;
  stats.shadow_rays = profile.shadow_rays;
  stats.invalid_samples = profile.invalid_samples;
  stats.paths_by_length = profile.paths_by_length;
  for (int i = 0; i < kStageCount; ++i) {
    const StageCounter& c = profile.stages[static_cast<size_t>(i)];
    if (c.calls == 0) continue;
    stats.stages.push_back({kStageNames[i], c.calls, c.paths, static_cast<double>(c.nanoseconds) * 1e-9,
                            static_cast<double>(c.paths) / static_cast<double>(c.lanes)});
  }
  return stats;
}

uint32_t thread_count(const Settings& settings, size_t items) {
  const uint32_t asked = settings.threads > 0 ? settings.threads : std::max(1u, std::thread::hardware_concurrency());
  return static_cast<uint32_t>(std::clamp<size_t>(items, 1, asked));
}

}  // namespace lanewise
