#include "core/rank_messages.h"

namespace lanewise {

std::vector<PixelRun> runs_of(const std::vector<uint32_t>& pixels) {
  std::vector<PixelRun> runs;
  for (const uint32_t pixel : pixels) {
    if (!runs.empty() && runs.back().first + runs.back().count == pixel) {
      ++runs.back().count;
    } else {
      runs.push_back({pixel, 1});
    }
  }
  return runs;
}

std::vector<uint32_t> pixels_of(const std::vector<PixelRun>& runs) {
  std::vector<uint32_t> pixels;
  for (const PixelRun& run : runs) {
    for (uint32_t i = 0; i < run.count; ++i) pixels.push_back(run.first + i);
  }
  return pixels;
}

void put(ByteWriter& out, const Profile& profile) {
  out.put(static_cast<uint32_t>(profile.bounces.size()));
  for (const auto& stages : profile.bounces) {
    for (const StageCounter& counter : stages) {
      const bool ran = counter.calls > 0 || counter.rays > 0;
      out.put(ran);
      if (ran) out.put(counter);
    }
  }
  out.put(profile.paths_by_length);
  for (const uint64_t n :
       {profile.waves, profile.calm_waves, profile.wave_nanoseconds, profile.calm_wave_nanoseconds, profile.samples,
        profile.light_paths, profile.bounce_rays, profile.shadow_rays, profile.invalid_samples}) {
    out.put(n);
  }
}

Profile get_profile(ByteReader& in) {
  Profile profile;
  for (auto bounces = in.get<uint32_t>(); bounces > 0; --bounces) {
    for (StageCounter& counter : profile.bounces.emplace_back()) {
      if (in.get<bool>()) counter = in.get<StageCounter>();
    }
  }
  profile.paths_by_length = in.list<uint64_t>();
  for (uint64_t* n :
       {&profile.waves, &profile.calm_waves, &profile.wave_nanoseconds, &profile.calm_wave_nanoseconds,
        &profile.samples, &profile.light_paths, &profile.bounce_rays, &profile.shadow_rays, &profile.invalid_samples}) {
    *n = in.get<uint64_t>();
  }
  return profile;
}

}  // namespace lanewise
