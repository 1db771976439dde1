// What a render counts: calls, paths, lanes, rays and time of each stage at each bounce, and the lengths of paths.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/queue_lengths.h"
#include "core/stages.h"
#include "core/types.h"

namespace lanewise {

// Bounces are told apart up to this many; the last stands for all that follow.
constexpr uint32_t kProfiledBounces = 16;

struct StageCounter {
  uint64_t calls = 0;
  uint64_t paths = 0;        // living, without padding
  uint64_t lanes = 0;        // run, with padding
  uint64_t rays = 0;         // traced
  uint64_t nanoseconds = 0;  // this and the next two are 0 if the clock is off: see ProfileDetail
  // Of the calls in calm waves, in which the thread ran all the time: what else the machine does is not in them.
  uint64_t calm_paths = 0;
  uint64_t calm_nanoseconds = 0;
  QueueLengths lengths;  // paths of each call

  void add(const StageCounter& other) {
    calls += other.calls;
    paths += other.paths;
    lanes += other.lanes;
    rays += other.rays;
    nanoseconds += other.nanoseconds;
    calm_paths += other.calm_paths;
    calm_nanoseconds += other.calm_nanoseconds;
    lengths.add(other.lengths);
  }
};

struct Profile {
  // [bounce][stage], as many bounces as there were. What runs once a wave (generate, emission, accumulate) counts as bounce 0.
  std::vector<std::array<StageCounter, kStageCount>> bounces;
  // Zeros if the clock is off. Times are those in stages and between them; for calm see StageCounter.
  uint64_t waves = 0, calm_waves = 0;
  uint64_t wave_nanoseconds = 0, calm_wave_nanoseconds = 0;
  uint64_t samples = 0;
  uint64_t light_paths = 0;
  uint64_t bounce_rays = 0;
  uint64_t shadow_rays = 0;
  uint64_t invalid_samples = 0;
  std::vector<uint64_t> paths_by_length;  // by scattering events

  uint64_t rays() const { return samples + light_paths + bounce_rays + shadow_rays; }

  StageCounter& at(Stage stage, uint32_t bounce) {
    bounce = std::min(bounce, kProfiledBounces - 1);
    if (bounce >= bounces.size()) bounces.resize(bounce + 1);
    return bounces[bounce][static_cast<size_t>(stage)];
  }

  // Over all bounces.
  StageCounter total(Stage stage) const {
    StageCounter sum;
    for (const auto& stages : bounces) sum.add(stages[static_cast<size_t>(stage)]);
    return sum;
  }

  // Rays that a stage has traced beside the calls that are counted for it. Camera rays are the samples.
  void count_rays(Stage stage, uint32_t bounce, uint64_t rays) {
    at(stage, bounce).rays += rays;
    if (stage != Stage::kIntersect) {
      shadow_rays += rays;
    } else if (bounce > 0) {
      bounce_rays += rays;
    }
  }

  void count_paths(size_t length, uint64_t paths) {
    if (paths == 0) return;
    if (paths_by_length.size() <= length) paths_by_length.resize(length + 1);
    paths_by_length[length] += paths;
  }

  void add(const Profile& other) {
    if (bounces.size() < other.bounces.size()) bounces.resize(other.bounces.size());
    for (size_t b = 0; b < other.bounces.size(); ++b) {
      for (size_t i = 0; i < kStageCount; ++i) bounces[b][i].add(other.bounces[b][i]);
    }
    waves += other.waves;
    calm_waves += other.calm_waves;
    wave_nanoseconds += other.wave_nanoseconds;
    calm_wave_nanoseconds += other.calm_wave_nanoseconds;
    samples += other.samples;
    light_paths += other.light_paths;
    bounce_rays += other.bounce_rays;
    shadow_rays += other.shadow_rays;
    invalid_samples += other.invalid_samples;
    for (size_t k = 0; k < other.paths_by_length.size(); ++k) count_paths(k, other.paths_by_length[k]);
  }
};

}  // namespace lanewise
