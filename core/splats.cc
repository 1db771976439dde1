#include "core/splats.h"

#include <cmath>

namespace lanewise {

void Splats::add(const PathState& s, Range range) {
  for (uint32_t i = range.begin; i < range.end; ++i) {
    const float r = s.L_r[i], g = s.L_g[i], b = s.L_b[i];
    if (r == 0 && g == 0 && b == 0) continue;
    const auto valid = [](float x) { return x >= 0 && std::isfinite(x); };
    if (valid(r) && valid(g) && valid(b)) {
      list.push_back({s.raster[i], r, g, b});
    } else {
      ++invalid;
    }
  }
}

}  // namespace lanewise
