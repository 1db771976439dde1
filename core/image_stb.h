// Pictures of 8 and 16 bits through stb.
#pragma once

#include <cstdint>
#include <string>

#include "core/image.h"
#include "core/texture.h"

namespace lanewise {

constexpr uint64_t kMaxStbBytes = 0x7FFFFFFF;  // stb counts in int

// sRGB in 8 bits; values that are not finite become 0.
std::string encode_png(const Image& image);

// Both throw Error with the reason, without a path, also for more than max_pixels, or many more than the file's bytes can stand for,
// before they are read.
Image decode_png(const std::string& bytes, uint64_t max_pixels);  // 8 or 16 bits, to linear light
// PNG, JPEG, BMP or TGA; 16 bits lose 8, alpha all.
Texture decode_texture(const std::string& bytes, uint64_t max_pixels);

}  // namespace lanewise
