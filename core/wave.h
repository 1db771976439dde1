// The renderer: one thread's batch of paths, taken from the camera to the film by kernels in reading order.
#pragma once

#include "core/path_buffer.h"
#include "core/plan.h"
#include "core/plan_light_paths.h"
#include "core/profiler.h"
#include "core/splats.h"
#include "kernels/kernels.h"

namespace lanewise {

class Wave {
 public:
  // size: the most paths in flight, a multiple of kLanes.
  Wave(const Plan& plan, uint32_t size, ProfileDetail detail = {});

  // Computes the batch's samples (at most size() paths) and adds them to their pixels' sums in the film.
  void run(const Batch& batch, PixelSums* film);

  // Follows the light paths of a piece (at most size()), and adds what the camera sees of them.
  void run_light_paths(const LightPiece& piece, Splats& splats);

  uint32_t size() const { return size_; }
  const Profiler& profiler() const { return profiler_; }

  // Of memory, that its paths take.
  static size_t bytes(const Plan& plan, uint32_t size);

 private:
  // The room of the k-th of its four parts.
  float* memory(size_t k) { return memory_.data() + k * PathBuffer::bytes(size_) / sizeof(float); }
  // Runs a stage's kernel on the range, which holds `paths` living paths, and counts it.
  void run(Stage stage, const PathState& s, Range range, uint32_t paths);
  void run(Stage stage, Range range, uint32_t paths) { run(stage, state_, range, paths); }
  void run(Stage stage, Range range) { run(stage, range, range.size()); }
  Bins sort(Range range, uint32_t paths);
  // Counts a call, and clocks it as long as what is returned lasts.
  Profiler::Call count(Stage stage, Range range, uint32_t paths);
  void see(Range vertices, Splats& splats);
  void take_adjoint(Range range, uint32_t paths, bool leaving);
  // Notes which paths leave the lamps that come next to light paths.
  void take_lamps(const Bins& bins);
  void leave_lamps(Range range, uint32_t paths);
  void share_paths(Range slots);
  void add_direct_light(const Bins& bins);
  // One sample of the light of state_.step at the vertices in the rough bins: `aim` makes it, `trace` adds it where it is seen,
  // by as many rays each.
  void add_light_sample(const Bins& bins, Stage aim, Stage trace, uint32_t rays);

  const Plan& plan_;
  uint32_t size_;
  uint32_t first_bounces_;
  ZeroedVector<float> memory_;  // of all that follows, in one piece
  PathBuffer buffers_[2];
  PathState state_;     // where the paths are now
  PathState spare_;     // where the next sort moves them
  PathQueue emitters_;  // the paths that have met one, of all bounces
  KeptBuffer kept_;
  Profiler profiler_;
  Profile& profile_ = profiler_.profile;
};

}  // namespace lanewise
