// Pictures that stb must not be given.
#pragma once

#include <string_view>

namespace lanewise {

// stb 2.27 writes Huffman tables of more than 256 codes beyond their end, and allocates what a chunk of PNG claims to be long, up to
// 2 GiB, before it looks for it in the file. Throws Error with the reason for JPEG and PNG files that have such.
void guard_stb(std::string_view bytes);

}  // namespace lanewise
