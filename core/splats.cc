#include "core/splats.h"

#include <cmath>

namespace lanewise {

uint32_t add_splats(const PathState& s, Range range, Splats& splats) {
  const auto valid = [](float x) { return x >= 0 && std::isfinite(x); };
  uint32_t invalid = 0;
  for (uint32_t i = range.begin; i < range.end; ++i) {
    const float r = s.L_r[i], g = s.L_g[i], b = s.L_b[i];
    if (r == 0 && g == 0 && b == 0) continue;
    if (valid(r) && valid(g) && valid(b)) {
      splats.push_back({s.raster[i], r, g, b});
    } else {
      ++invalid;
    }
  }
  return invalid;
}

}  // namespace lanewise
