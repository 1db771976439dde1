// Radiance pictures (Ward, Real Pixels, Graphics Gems II): three 8-bit mantissas with one exponent. image_io.h is the
// way in.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/image.h"

namespace lanewise {

// Mantissas are rounded to nearest, so that a mean survives. Negative values, NaN and Inf become 0.
std::string encode_hdr(const Image& image);

// Flat and run-length encoded scan lines, from the top. Throws Error for a damaged file, also for one that claims more
// than max_pixels.
Image decode_hdr(std::string_view bytes, uint64_t max_pixels);

}  // namespace lanewise
