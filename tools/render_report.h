// What `lanewise render` tells about a finished render.
#pragma once

#include <string>

#include "core/explain.h"
#include "core/render.h"
#include "tools/render_options.h"

namespace lanewise {

struct RenderSeconds {
  double load = 0;
  double plan = 0;
  double render = 0;
  double write = 0;
};

struct RenderReport {
  const RenderOptions& options;
  const RenderStats& stats;
  RenderSeconds seconds;
  std::string isa;
  std::string command_line;
  const std::vector<Decision>& plan;
};

// For --stats: scene, command, version, width, height, spp (the most of a pixel), max_depth, seed, threads, isa, wave, seconds {load, plan,
// render, write}, samples (which may be more than the window's, where paths of pixels around it are used again), rays {camera,
// bounce, shadow, total}, rays_per_second, peak_rss_bytes, invalid_samples,
// paths_by_length [], time_budget (seconds) with --time, estimated_mrse {value, low, high} where there is one, stages [{name, calls, paths, seconds, lanes_live}] and plan [as decisions_json() gives it].
std::string stats_json(const RenderReport& report);

// "64", or where it is not the same for all pixels or not known beforehand, their mean "61.5".
std::string samples_per_pixel(const RenderOptions& options, const RenderStats& stats);

// For the terminal: a few lines.
std::string summary(const RenderReport& report);

}  // namespace lanewise
