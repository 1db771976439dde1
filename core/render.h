// From a plan to a picture: tiles over threads, progress, statistics.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/error_estimate.h"
#include "core/image.h"
#include "core/plan.h"
#include "core/profiler.h"
#include "core/render_control.h"
#include "core/settings.h"
#include "core/zeroed_pages.h"

namespace lanewise {

// One stage's work over a render, summed over threads.
struct StageStats {
  std::string name;
  uint64_t calls = 0;
  uint64_t paths = 0;     // paths handed to the stage, without padding
  double seconds = 0;     // of thread time; 0 if the clock is off
  double lanes_live = 0;  // share of the vector lanes that it ran which held a living path
};

// What a rank had to do with a render.
struct RankStats {
  uint32_t rank = 0;
  uint32_t threads = 0;
  uint64_t samples = 0;
  uint64_t bytes_sent = 0, bytes_received = 0;  // by it, to and from rank 0; 0 for rank 0
};

struct RenderStats {
  uint64_t samples = 0;  // also those of probes
  uint64_t camera_rays = 0;
  uint64_t light_paths = 0;  // the first ray of each; the others are bounce rays and shadow rays
  uint64_t bounce_rays = 0;
  uint64_t shadow_rays = 0;
  uint64_t invalid_samples = 0;           // NaN, Inf or negative radiance: counted as 0 in the picture
  std::vector<uint64_t> paths_by_length;  // [k]: paths of k scattering events; sums to samples
  std::vector<StageStats> stages;
  double samples_per_pixel = 0;  // mean over the picture; samples counts also those around a crop that --noise looks at
  bool stopped = false;          // before all was drawn
  double converged = 1;          // share of the pixels that reached what -a or --noise asks for
  std::optional<ErrorEstimate> error;  // none with -a, of one sample a pixel, or if not asked for
  double seconds = 0;                  // wall clock of rendering alone
  uint32_t threads = 0;                // that did some of the work; of ranks, all that they have
  std::vector<RankStats> ranks;        // none if there is one process
};

struct RenderResult {
  Image image;                     // of settings.window()
  ZeroedVector<uint64_t> samples;  // per pixel of it
  RenderStats stats;
  Profile profile;                            // what the statistics are made of, of all threads
  std::vector<std::vector<LoggedCall>> logs;  // of each thread, by the time that calls ended
};

// Renders plan.settings. The pixels depend on the plan's scene, settings and seed alone: not on threads, wave or tile order, nor on
// where it was stopped and resumed.
RenderResult render(const Plan& plan, const RenderControl& control = {}, ProfileDetail detail = {});

// The same picture by the scalar path tracer made of the twins: T is float or double.
template <class T>
RenderResult render_reference(const Plan& plan, const RenderControl& control = {});

}  // namespace lanewise
