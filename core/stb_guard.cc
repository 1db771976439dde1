#include "core/stb_guard.h"

#include <cstddef>
#include <cstdint>

#include "core/types.h"

namespace lanewise {
namespace {

constexpr uint8_t kEndOfImage = 0xD9, kHuffmanTables = 0xC4, kFirstRestart = 0xD0;

// The tables of a segment of that length: for each a byte that names it, 16 that say how many codes there are of each length, and
// a byte for each code. stb reads on to the end of a table that leaves its segment; it writes the 257th code out of bounds, and
// cannot tell the 256th from none (pictures have no use for more than 176).
bool has_overlong_table(std::string_view tables, size_t length) {
  for (size_t at = 0; at < length;) {
    size_t codes = 0;
    for (size_t i = at + 1; i < at + 17 && i < tables.size(); ++i) codes += static_cast<uint8_t>(tables[i]);
    if (codes > 255) return true;
    at += 17 + codes;
  }
  return false;
}

// Of markers that stand alone.
bool has_length(uint8_t marker) {
  return marker != 0 && marker != 0xFF && (marker < kFirstRestart || marker > kEndOfImage);
}

// Of a JPEG file.
bool has_overlong_huffman_table(std::string_view bytes) {
  const auto byte = [&](size_t i) { return i < bytes.size() ? static_cast<uint8_t>(bytes[i]) : uint8_t{0}; };
  // Whatever looks like a marker where stb may look for one: between segments, and among the entropy-coded data.
  for (size_t at = 0; at + 1 < bytes.size();) {
    if (byte(at) != 0xFF || !has_length(byte(at + 1))) {
      ++at;
      continue;
    }
    const size_t length = size_t{byte(at + 2)} << 8 | byte(at + 3), begin = at + 4;
    if (byte(at + 1) == kHuffmanTables && length > 2 && begin <= bytes.size() &&
        has_overlong_table(bytes.substr(begin), length - 2)) {
      return true;
    }
    at += length < 2 ? 2 : 2 + length;
  }
  return false;
}

// Of a PNG file: a length, four letters, so many bytes, and a checksum each, to the one that is called IEND.
bool has_overlong_chunk(std::string_view bytes) {
  constexpr size_t kSignature = 8, kAround = 12;
  for (size_t at = kSignature; bytes.size() >= at + kSignature;) {
    size_t length = 0;
    for (size_t i = 0; i < 4; ++i) length = length << 8 | static_cast<uint8_t>(bytes[at + i]);
    if (length > bytes.size() - at - kSignature) return true;
    if (bytes.substr(at + 4, 4) == "IEND") return false;
    at += length + kAround;
  }
  return false;
}

}  // namespace

void guard_stb(std::string_view bytes) {
  if (bytes.starts_with('\xFF') && has_overlong_huffman_table(bytes)) {
    throw Error("damaged picture (a Huffman table of more than 255 codes)");
  }
  if (bytes.starts_with("\x89PNG") && has_overlong_chunk(bytes))
    throw Error("damaged picture (a chunk leaves the file)");
}

}  // namespace lanewise
