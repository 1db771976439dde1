// The header of an OpenEXR file, before OpenEXR reads it.
#pragma once

#include <string_view>

namespace lanewise {

// OpenEXR 3.1 allocates what a text claims to be long, up to 2 GiB, before it looks for it in the file, and does not hold values to
// the size that the file gives for them. Throws Error if a value has another size than its type, or leaves the file.
void check_exr_header(std::string_view bytes);

}  // namespace lanewise
