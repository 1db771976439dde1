// FNV-1a by words of 64 bits: tells what has changed, not who changed it.
#pragma once

#include <cstdint>
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
  template <class T>
  void add(const std::vector<T>& values) {
    add(uint64_t{values.size()});
    for (const T& value : values) {
      if constexpr (std::is_floating_point_v<T>) {
        add(double{value});
      } else {
        add(uint64_t{value});
      }
    }
  }
  uint64_t hash() const { return hash_; }

 private:
  uint64_t hash_ = 0xcbf29ce484222325u;
};

}  // namespace lanewise
