#include "core/exr_header.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <utility>

#include "core/types.h"

namespace lanewise {
namespace {

// The types whose values have one size, in bytes; of others but those below OpenEXR reads as many bytes as the file says.
constexpr std::pair<std::string_view, size_t> kSizes[] = {{"box2f", 16},
                                                          {"box2i", 16},
                                                          {"chromaticities", 32},
                                                          {"compression", 1},
                                                          {"deepImageState", 1},
                                                          {"double", 8},
                                                          {"envmap", 1},
                                                          {"float", 4},
                                                          {"int", 4},
                                                          {"keycode", 28},
                                                          {"lineOrder", 1},
                                                          {"m33d", 72},
                                                          {"m33f", 36},
                                                          {"m44d", 128},
                                                          {"m44f", 64},
                                                          {"rational", 8},
                                                          {"tiledesc", 9},
                                                          {"timecode", 8},
                                                          {"v2d", 16},
                                                          {"v2f", 8},
                                                          {"v2i", 8},
                                                          {"v3d", 24},
                                                          {"v3f", 12},
                                                          {"v3i", 12}};

class Header {
 public:
  explicit Header(std::string_view bytes) : left_(bytes) {}

  void check() {
    const std::string_view start = take(8);  // the magic number and the version, whose second byte has flags
    constexpr unsigned kManyParts = 0x10;
    const bool many = (static_cast<uint8_t>(start[5]) & kManyParts) != 0;
    // An empty name ends a header, and an empty header those of many parts.
    do {
      while (true) {
        const std::string_view name = text();
        if (name.empty()) break;
        const std::string_view type = text();
        check_value(type, take(number()));
      }
    } while (many && left_.substr(0, 1) != std::string_view("\0", 1));
  }

 private:
  std::string_view take(size_t n) {
    if (n > left_.size()) throw Error("damaged picture (its header leaves the file)");
    const std::string_view taken = left_.substr(0, n);
    left_.remove_prefix(n);
    return taken;
  }
  std::string_view text() {
    const std::string_view found = take(std::min(left_.find('\0'), left_.size()));
    take(1);
    return found;
  }
  size_t number() {  // little-endian, as the machine is; what is negative is far beyond any file
    uint32_t value = 0;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  bool ends() const { return left_.empty(); }

  static void check_value(std::string_view type, std::string_view value) {
    const auto known = std::ranges::find(kSizes, type, &std::pair<std::string_view, size_t>::first);
    Header inside(value);
    bool fits = true;
    if (known != std::end(kSizes)) {
      fits = value.size() == known->second;
    } else if (type == "chlist") {
      while (!inside.text().empty()) inside.take(16);
      fits = inside.ends();
    } else if (type == "preview") {
      const uint64_t width = inside.number(), height = inside.number();
      fits = width < 1 << 16 && height < 1 << 16 && 8 + 4 * width * height == value.size();
    } else if (type == "stringvector") {
      while (!inside.ends()) inside.take(inside.number());
    }
    if (!fits) throw Error("damaged picture (a value of its header has the wrong size)");
  }

  std::string_view left_;
};

}  // namespace

void check_exr_header(std::string_view bytes) { Header(bytes).check(); }

}  // namespace lanewise
