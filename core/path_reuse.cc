#include "core/path_reuse.h"

#include <algorithm>

#include "core/plan_light_paths.h"

namespace lanewise {
namespace {

bool has_flat_diffuse_surface(const Plan& plan) {
  return std::ranges::any_of(plan.groups, [&](const PlanGroup& group) {
    const bool mesh = group.first < plan.triangles;  // of one material
    const auto bins = plan.prim_bin.begin() + group.first;
    return !group.smooth && std::find(bins, bins + (mesh ? 1 : group.size), kDiffuse) != bins + (mesh ? 1 : group.size);
  });
}

}  // namespace

const char* why_no_reuse(const Plan& plan) {
  const Settings& settings = plan.settings;
  if (!settings.reuse) return "--reuse off";
  if (settings.max_depth < 2 || (settings.only_bounce && *settings.only_bounce < 2))
    return "no path of two scattering events";
  if (sampled_lights(plan) == 0) return "no light";
  if (settings.adaptive_batch > 0 || settings.noise > 0) return "-a and --noise stop pixels one by one";
  if (settings.direct == Direct::kHemisphere) return "--direct hemisphere";
  return has_flat_diffuse_surface(plan) ? "" : "no flat diffuse surface";
}

uint32_t first_bounces(const Plan& plan) {
  if (!reuses_paths(plan)) return 0;
  return std::ranges::any_of(plan.prim_bin, casts) ? std::min(plan.settings.max_depth - 1, kFirstBounces) : 1;
}

PixelSquares squares_of(const std::vector<uint32_t>& pixels, const uint32_t* slots, uint32_t width, uint32_t height) {
  constexpr uint64_t kNone = ~uint64_t{0};
  struct Last {
    uint64_t row = kNone;  // of squares
    size_t begin = 0;      // in the lists
  };
  std::vector<Last> last((width + kTogetherSide - 1) / kTogetherSide);  // that has come, by column of squares
  PixelSquares squares;
  for (size_t j = 0; j < pixels.size(); ++j) {
    const uint32_t x = pixels[j] % width, y = pixels[j] / width;
    const uint32_t column = x / kTogetherSide, row = y / kTogetherSide;
    Last& square = last[column];
    if (square.row != row) {
      square = {row, squares.pixels.size()};
      for (uint32_t v = row * kTogetherSide; v < (row + 1) * kTogetherSide; ++v) {
        for (uint32_t u = column * kTogetherSide; u < (column + 1) * kTogetherSide; ++u) {
          squares.pixels.push_back(u < width && v < height ? v * width + u : kNoPixel);
        }
      }
      squares.slots.resize(squares.pixels.size(), kNoPixel);
    }
    const size_t member = y % kTogetherSide * kTogetherSide + x % kTogetherSide;
    squares.slots[square.begin + member] = slots ? slots[j] : pixels[j];
  }
  return squares;
}

}  // namespace lanewise
