// --rate: the picture of how many samples each pixel took.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/image.h"

namespace lanewise {

// For a file that holds colours (.png): dark blue for the fewest samples of any pixel, over green to yellow for the most, by
// the logarithm of their number. For one of floats (.exr, .pfm, .hdr): the numbers themselves, in every channel.
Image rate_picture(const std::string& path, const ZeroedVector<uint64_t>& samples, uint32_t width, uint32_t height);

}  // namespace lanewise
