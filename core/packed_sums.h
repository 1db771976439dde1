// A pixel's sums in as few bytes as they need: what crosses the network for every pixel.
//
// Most of a sum's 16 bytes are zero: those above its value, and, as samples are floats, those below the last bit of the darkest.
// Of a pixel's 80 bytes some 30 are left (perf/results/ranks.md).
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>

#include "core/bytes.h"
#include "core/pixel_sums.h"

namespace lanewise {

// A byte with the number of zero bytes at the low end and the length of what follows them, and that, lowest first.
inline void pack(Uint128 units, std::string& out) {
  constexpr char kZero = '\xFF';
  if (units == 0) return out.push_back(kZero);
  const auto low_half = static_cast<uint64_t>(units), high_half = static_cast<uint64_t>(units >> 64);
  const int begin = (low_half != 0 ? std::countr_zero(low_half) : 64 + std::countr_zero(high_half)) / 8;
  const int end = ((high_half != 0 ? 128 - std::countl_zero(high_half) : 64 - std::countl_zero(low_half)) + 7) / 8;
  char bytes[sizeof units];
  std::memcpy(bytes, &units, sizeof units);
  out.push_back(static_cast<char>(begin << 4 | (end - begin - 1)));
  out.append(bytes + begin, static_cast<size_t>(end - begin));
}

inline Uint128 unpack(ByteReader& in) {
  const auto head = in.get<uint8_t>();
  const size_t begin = head >> 4, length = (head & 15) + size_t{1};
  if (head == 0xFF) return 0;
  if (begin + length > sizeof(Uint128)) throw std::out_of_range("a sum is too long");
  char bytes[sizeof(Uint128)] = {};
  std::memcpy(bytes + begin, in.take(length).data(), length);
  Uint128 units;
  std::memcpy(&units, bytes, sizeof units);
  return units;
}

inline void pack(const PixelSums& sums, std::string& out) {
  for (const Uint128 units : {sums.r.units(), sums.g.units(), sums.b.units(), sums.y.units(), sums.y2.units()})
    pack(units, out);
}

inline PixelSums unpack_sums(ByteReader& in) {
  PixelSums sums;
  sums.r = decltype(sums.r)(unpack(in));
  sums.g = decltype(sums.g)(unpack(in));
  sums.b = decltype(sums.b)(unpack(in));
  sums.y = decltype(sums.y)(unpack(in));
  sums.y2 = decltype(sums.y2)(unpack(in));
  return sums;
}

}  // namespace lanewise
