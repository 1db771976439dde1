// Environment maps from files.
#pragma once

#include <string>

#include "core/image.h"

namespace lanewise {

// Reads a map of radiance for Scene::environment: .exr, .hdr or .pfm (core/image_io.h), commonly twice as wide as high. Throws
// Error, one line that names the file, for one that cannot be read, is larger than kMaxEnvironmentSide or
// kMaxEnvironmentTexels, or has a texel that is negative or not finite.
Image load_environment(const std::string& path);

}  // namespace lanewise
