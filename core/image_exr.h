// OpenEXR pictures; image_io.h is the way in.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/image.h"

namespace lanewise {

// A scan-line file, channels R, G and B as 32-bit floats, ZIP-compressed; metadata as string attributes. Throws
// std::exception.
std::string encode_exr(const Image& image, const std::vector<std::pair<std::string, std::string>>& metadata);

// The data window of R, G and B, or of Y for all three; a channel that is missing is 0. Throws std::exception, also for
// more than max_pixels.
Image read_exr(const std::string& path, uint64_t max_pixels);

}  // namespace lanewise
