// A hash like FNV-1a, by words of 64 bits; as a product carries bits upwards alone, the high ones are brought down at each step.
// It tells what has changed, not who changed it.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lanewise {

class Fnv {
 public:
  void add(uint64_t x) { hash_ = (hash_ ^ x) * 0x100000001b3u ^ hash_ >> 29; }
  void add(double x) {
    uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    add(bits);
  }
  void add(std::string_view text) {
    add(uint64_t{text.size()});
    for (const char c : text) add(uint64_t{static_cast<unsigned char>(c)});
  }
  template <class T, class Allocator>
  void add(const std::vector<T, Allocator>& values) {
    add(uint64_t{values.size()});
    for (const T& value : values) {
      if constexpr (std::is_floating_point_v<T>) {
        add(double{value});
      } else {
        add(uint64_t{value});
      }
    }
  }
  std::string hex() const {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash_));
    return text;
  }

 private:
  uint64_t hash_ = 0xcbf29ce484222325u;
};

}  // namespace lanewise
