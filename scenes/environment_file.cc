#include "scenes/environment_file.h"

#include <algorithm>
#include <limits>

#include "core/environment_map.h"
#include "core/image_io.h"
#include "core/types.h"

namespace lanewise {

Image load_environment(const std::string& path) {
  check_image_extension(path);
  if (holds_colours(path)) throw UsageError(path + ": an environment map holds radiance, as .exr, .hdr or .pfm");
  Image map = read_image(path);
  if (std::max(map.width, map.height) > kMaxEnvironmentSide ||
      uint64_t{map.width} * map.height > kMaxEnvironmentTexels) {
    throw Error(path + ": " + std::to_string(map.width) + " x " + std::to_string(map.height) +
                " are more texels than an environment map may have: 65536 a side, 2^27 in all");
  }
  const auto bad = std::ranges::find_if(
      map.rgb, [](float x) { return !(x >= 0 && x <= std::numeric_limits<float>::max()); });  // so that NaN is
  if (bad != map.rgb.end()) {
    const size_t texel = static_cast<size_t>(bad - map.rgb.begin()) / 3;
    throw Error(path + ": the texel in column " + std::to_string(texel % map.width) + " of row " +
                std::to_string(texel / map.width) + " is " + (*bad < 0 ? "negative" : "not finite"));
  }
  return map;
}

}  // namespace lanewise
