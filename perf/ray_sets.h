// The rays that a render traces, set by set: from the camera, from each bounce, and towards lights.
#pragma once

#include <string>
#include <vector>

#include "core/path_buffer.h"
#include "core/plan.h"

namespace lanewise::perf {

// Rays in the order in which the renderer traces them, wave by wave, ready for intersect (o, d) or, of shadow rays, for
// occlude (o, n, err, l, c).
struct RaySet {
  std::string name;
  std::vector<PathBuffer> waves;
  std::vector<uint32_t> counts;  // paths of each wave
  bool shadow = false;

  size_t rays() const;
};

// One sample a pixel of plan.settings: sets "camera", "bounce 1" to "bounce `bounces`" and "shadow" (of all vertices).
std::vector<RaySet> collect_rays(const Plan& plan, uint32_t bounces);

}  // namespace lanewise::perf
