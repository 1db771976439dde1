#include "tools/colour_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include "core/srgb.h"

namespace lanewise {
namespace {

// Every 17th of matplotlib's 256 colours, sRGB.
constexpr float kViridis[][3] = {
    {0.267f, 0.005f, 0.329f}, {0.283f, 0.100f, 0.422f}, {0.277f, 0.185f, 0.490f}, {0.254f, 0.265f, 0.530f},
    {0.222f, 0.339f, 0.549f}, {0.191f, 0.407f, 0.556f}, {0.164f, 0.471f, 0.558f}, {0.139f, 0.534f, 0.555f},
    {0.121f, 0.596f, 0.544f}, {0.135f, 0.659f, 0.518f}, {0.208f, 0.719f, 0.473f}, {0.328f, 0.774f, 0.407f},
    {0.478f, 0.821f, 0.318f}, {0.647f, 0.858f, 0.210f}, {0.825f, 0.885f, 0.106f}, {0.993f, 0.906f, 0.144f}};
constexpr float kMagma[][3] = {
    {0.001f, 0.000f, 0.014f}, {0.044f, 0.034f, 0.142f}, {0.124f, 0.067f, 0.296f}, {0.232f, 0.060f, 0.438f},
    {0.341f, 0.081f, 0.493f}, {0.445f, 0.123f, 0.507f}, {0.550f, 0.161f, 0.506f}, {0.658f, 0.196f, 0.490f},
    {0.767f, 0.234f, 0.458f}, {0.869f, 0.288f, 0.409f}, {0.944f, 0.378f, 0.365f}, {0.981f, 0.498f, 0.370f},
    {0.995f, 0.624f, 0.427f}, {0.997f, 0.748f, 0.517f}, {0.993f, 0.870f, 0.626f}, {0.987f, 0.991f, 0.750f}};

template <size_t n>
std::array<float, 3> between(const float (&colours)[n][3], double x) {
  const double at = x * double{n - 1};
  const size_t step = std::min(static_cast<size_t>(at), n - 2);
  std::array<float, 3> rgb;
  for (size_t k = 0; k < 3; ++k) {
    const double srgb = std::lerp(colours[step][k], colours[step + 1][k], at - static_cast<double>(step));
    rgb[k] = static_cast<float>(linear_from_srgb(srgb));
  }
  return rgb;
}

}  // namespace

std::array<float, 3> viridis(double x) { return between(kViridis, x); }
std::array<float, 3> magma(double x) { return between(kMagma, x); }

}  // namespace lanewise
