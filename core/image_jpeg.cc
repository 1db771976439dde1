#include "core/image_jpeg.h"

#include <cstddef>
#include <cstdint>

namespace lanewise {
namespace {

constexpr uint8_t kEndOfImage = 0xD9, kHuffmanTables = 0xC4, kFirstRestart = 0xD0;

// The tables of a segment of that length: for each a byte that names it, 16 that say how many codes there are of each length, and
// a byte for each code. stb reads on to the end of a table that leaves its segment.
bool has_overlong_table(std::string_view tables, size_t length) {
  for (size_t at = 0; at < length;) {
    size_t codes = 0;
    for (size_t i = at + 1; i < at + 17 && i < tables.size(); ++i) codes += static_cast<uint8_t>(tables[i]);
    if (codes > 256) return true;
    at += 17 + codes;
  }
  return false;
}

// Of markers that stand alone.
bool has_length(uint8_t marker) {
  return marker != 0 && marker != 0xFF && (marker < kFirstRestart || marker > kEndOfImage);
}

}  // namespace

bool has_overlong_huffman_table(std::string_view bytes) {
  if (!bytes.starts_with('\xFF')) return false;
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

}  // namespace lanewise
