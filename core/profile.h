// What a wave counts while it runs: calls, paths, lanes and time of each stage, rays, and the lengths of paths.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/stages.h"
#include "core/types.h"

namespace lanewise {

struct StageCounter {
  uint64_t calls = 0;
  uint64_t paths = 0;  // living, without padding
  uint64_t lanes = 0;  // run, with padding
  uint64_t nanoseconds = 0;
};

struct Profile {
  std::array<StageCounter, kStageCount> stages;
  uint64_t samples = 0;
  uint64_t bounce_rays = 0;
  uint64_t shadow_rays = 0;
  uint64_t invalid_samples = 0;
  std::vector<uint64_t> paths_by_length;  // by scattering events

  uint64_t rays() const { return samples + bounce_rays + shadow_rays; }

  StageCounter& operator[](Stage stage) { return stages[static_cast<size_t>(stage)]; }

  void count_paths(size_t length, uint64_t paths) {
    if (paths == 0) return;
    if (paths_by_length.size() <= length) paths_by_length.resize(length + 1);
    paths_by_length[length] += paths;
  }

  void add(const Profile& other) {
    for (int i = 0; i < kStageCount; ++i) {
      stages[i].calls += other.stages[i].calls;
      stages[i].paths += other.stages[i].paths;
      stages[i].lanes += other.stages[i].lanes;
      stages[i].nanoseconds += other.stages[i].nanoseconds;
    }
    samples += other.samples;
    bounce_rays += other.bounce_rays;
    shadow_rays += other.shadow_rays;
    invalid_samples += other.invalid_samples;
    for (size_t k = 0; k < other.paths_by_length.size(); ++k) count_paths(k, other.paths_by_length[k]);
  }
};

}  // namespace lanewise
