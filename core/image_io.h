// Pictures from and to files, by extension: .png (8-bit sRGB), .exr (float), .pfm (float), .hdr (RGBE).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/image.h"

namespace lanewise {

// Throws UsageError, naming the path, if the extension is none of the four. For the command line to call before
// rendering.
void check_image_extension(const std::string& path);

// Whether the file, by its extension, holds colours in 8 bits (.png) rather than radiance.
bool holds_colours(const std::string& path);

// Whether it is an .exr, which can also be a film file: see core/film_file.h.
bool is_exr(const std::string& path);

// Throws Error, naming the path, if no file can be written there (no such folder, a folder itself, no permission). For
// the command line to call before a long render; creates nothing.
void check_image_writable(const std::string& path);

// Writes to a temporary file beside the path and renames it, so that a good file is never half overwritten. metadata:
// key and value pairs, kept by .exr as string attributes and ignored by the others. NaN and Inf become 0 in .png and
// .hdr. Throws Error with the path and the reason.
void write_image(const std::string& path, const Image& image,
                 const std::vector<std::pair<std::string, std::string>>& metadata = {});

// The bytes of that file.
std::string encode_image(const std::string& path, const Image& image,
                         const std::vector<std::pair<std::string, std::string>>& metadata = {});

// Linear radiance; .png is decoded from sRGB. Refuses pictures of more than kMostPixels. Throws Error with the path.
Image read_image(const std::string& path);

}  // namespace lanewise
