// What the camera sees of light paths: radiance for pixels anywhere in the picture.
#pragma once

#include <cstdint>
#include <vector>

#include "core/path_state.h"

namespace lanewise {

struct Splat {
  uint32_t pixel;
  float r, g, b;
};

// Of one thread.
struct Splats {
  std::vector<Splat> list;
  uint64_t invalid = 0;  // left out: NaN, infinite or negative

  // The L of a range of paths, at their `raster`.
  void add(const PathState& s, Range range);
};

}  // namespace lanewise
