// Which pixels get how many samples: -s and --time the same for all, -a batches until a pixel has converged, --noise what the
// noise demands. Both renderers draw their samples through it, and differ only in how they draw.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/image.h"
#include "core/render.h"
#include "core/settings.h"
#include "kernels/kernels.h"

namespace lanewise {

// Adds samples first .. first + count - 1 of each of the pixels (y * width + x) to sums[pixel], in that order, on the thread
// that is called `worker`; returns how many rays that took.
using Draw = std::function<uint64_t(const std::vector<uint32_t>& pixels, uint32_t first, uint32_t count,
                                    PixelSums* sums, uint32_t worker)>;

// The picture of settings.window().
struct Exposure {
  Image image;
  std::vector<uint32_t> samples;  // drawn for each pixel of it
  double converged = 1;           // share of its pixels that reached what -a or --noise asks for
  std::optional<ErrorEstimate> error;
};

// Seconds since some moment, to be called from any thread.
using Clock = std::function<double()>;
double steady_seconds();

Exposure expose(const Settings& settings, uint32_t threads, const Draw& draw,
                const std::function<void(const Progress&)>& progress, const Clock& clock = steady_seconds);

}  // namespace lanewise
