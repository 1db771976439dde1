// Which pixels get how many samples: -s and --time the same for all, -a batches until a pixel has converged, --noise what the
// noise demands. Both renderers draw their samples through it, and differ only in how they draw.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/image.h"
#include "core/render.h"
#include "core/render_control.h"
#include "core/settings.h"
#include "kernels/kernels.h"

namespace lanewise {

// Adds samples first .. first + count - 1 of each of the pixels (y * width + x) to sums[pixel], on the thread that is called
// `worker`; returns how many rays that took.
using Draw = std::function<uint64_t(const std::vector<uint32_t>& pixels, uint64_t first, uint32_t count,
                                    PixelSums* sums, uint32_t worker)>;

// The picture of settings.window().
struct Exposure {
  Image image;
  std::vector<uint64_t> samples;  // drawn for each pixel of it
  bool stopped = false;           // before all was drawn
  double converged = 1;           // share of its pixels that reached what -a or --noise asks for
  std::optional<ErrorEstimate> error;
};

// workers: how many threads may draw at a time.
Exposure expose(const Settings& settings, uint32_t workers, const Draw& draw, const RenderControl& control = {});

}  // namespace lanewise
