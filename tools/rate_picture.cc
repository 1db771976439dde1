#include "tools/rate_picture.h"

#include <algorithm>
#include <cmath>

#include "core/image_io.h"
#include "tools/colour_map.h"

namespace lanewise {

Image rate_picture(const std::string& path, const ZeroedVector<uint64_t>& samples, uint32_t width, uint32_t height) {
  const bool colours = holds_colours(path);
  const auto [fewest, most] = std::minmax_element(samples.begin(), samples.end());
  const double low = std::log(static_cast<double>(*fewest)), span = std::log(static_cast<double>(*most)) - low;
  Image image(width, height);
  for (size_t i = 0; i < samples.size(); ++i) {
    float* rgb = &image.rgb[3 * i];
    if (colours) {
      std::ranges::copy(viridis(span > 0 ? (std::log(static_cast<double>(samples[i])) - low) / span : 0), rgb);
    } else {
      std::fill_n(rgb, 3, static_cast<float>(samples[i]));
    }
  }
  return image;
}

}  // namespace lanewise
