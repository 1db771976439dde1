// JPEG files that stb must not be given.
#pragma once

#include <string_view>

namespace lanewise {

// Whether a Huffman table of the file claims more than 256 codes: stb 2.27 writes them all, beyond its table's end. False for
// what is no JPEG file.
bool has_overlong_huffman_table(std::string_view bytes);

}  // namespace lanewise
