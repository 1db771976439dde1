// What the camera sees of light paths: radiance for pixels anywhere in the picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/path_state.h"
#include "core/zeroed_pages.h"

namespace lanewise {

struct Splat {
  uint32_t pixel;
  float r, g, b;
};

using Splats = ZeroedVector<Splat>;

// More are not kept for long.
constexpr size_t kMostSplats = 1 << 16;

// A list has room for so many from its beginning: for those, and what a wave adds before they are taken.
constexpr size_t kSplatRoom = 2 * kMostSplats;

// Adds the L of the range's paths, at their `raster`. Returns how many were invalid (NaN, infinite or negative), and left out.
uint32_t add_splats(const PathState& s, Range range, Splats& splats);

}  // namespace lanewise
