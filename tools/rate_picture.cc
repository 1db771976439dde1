#include "tools/rate_picture.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/image_io.h"
#include "core/srgb.h"

namespace lanewise {
namespace {

// Seven even steps of matplotlib's viridis (van der Walt & Smith, 2015), sRGB: even to the eye, and in grey too.
constexpr float kColours[][3] = {{0.267f, 0.005f, 0.329f}, {0.267f, 0.228f, 0.510f}, {0.191f, 0.407f, 0.556f},
                                 {0.128f, 0.567f, 0.551f}, {0.208f, 0.719f, 0.473f}, {0.565f, 0.842f, 0.262f},
                                 {0.993f, 0.906f, 0.144f}};
constexpr size_t kSteps = std::size(kColours) - 1;

// x in [0, 1].
void set_colour(double x, float* rgb) {
  const double at = x * double{kSteps};
  const size_t step = std::min(static_cast<size_t>(at), kSteps - 1);
  for (size_t k = 0; k < 3; ++k) {
    const double srgb = std::lerp(kColours[step][k], kColours[step + 1][k], at - static_cast<double>(step));
    rgb[k] = static_cast<float>(linear_from_srgb(srgb));
  }
}

}  // namespace

Image rate_picture(const std::string& path, const std::vector<uint32_t>& samples, uint32_t width, uint32_t height) {
  const bool colours = holds_colours(path);
  const auto [fewest, most] = std::minmax_element(samples.begin(), samples.end());
  const double low = std::log(*fewest), span = std::log(*most) - low;
  Image image(width, height);
  for (size_t i = 0; i < samples.size(); ++i) {
    float* rgb = &image.rgb[3 * i];
    if (colours) {
      set_colour(span > 0 ? (std::log(samples[i]) - low) / span : 0, rgb);
    } else {
      std::fill_n(rgb, 3, static_cast<float>(samples[i]));
    }
  }
  return image;
}

}  // namespace lanewise
