// How samples are drawn, and the picture that comes of it: what core/schedule.h and its ways share.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/error_estimate.h"
#include "core/image.h"
#include "core/light_film.h"
#include "core/plan_light_paths.h"
#include "core/pixel_sums.h"
#include "core/zeroed_pages.h"

namespace lanewise {

// Adds samples first .. first + count - 1 of each of the pixels (y * width + x) to sums[pixel], on the thread that is called
// `worker`; returns how many rays that took.
using Draw = std::function<uint64_t(const std::vector<uint32_t>& pixels, uint64_t first, uint32_t count,
                                    PixelSums* sums, uint32_t worker)>;

// Draws light paths.
class LightPathDraw {
 public:
  virtual ~LightPathDraw() = default;
  // Passes first .. first + passes - 1 in pieces for so many workers, and how many to draw at a time.
  virtual std::vector<LightPiece> pieces(uint64_t first, uint64_t passes, uint32_t workers) const = 0;
  virtual uint64_t passes_at_a_time(uint32_t workers) const = 0;
  // Adds what the camera sees of a piece, on the thread that is called `worker`; returns how many rays that took.
  virtual uint64_t draw(const LightPiece& piece, LightFilm& film, uint32_t worker) = 0;
};

// The picture of settings.window().
struct Exposure {
  Image image;
  ZeroedVector<uint64_t> samples;  // drawn for each pixel of it
  bool stopped = false;            // before all was drawn
  double converged = 1;            // share of its pixels that reached what -a or --noise asks for
  std::optional<ErrorEstimate> error;
};

}  // namespace lanewise
