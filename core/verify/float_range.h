// Floats of a domain, numbered in rising order.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace lanewise::verify {

// -0 comes before 0.
inline int64_t number_of(float x) {
  const uint32_t bits = std::bit_cast<uint32_t>(x);
  const int64_t size = bits & 0x7FFFFFFFu;
  return bits >> 31 ? -size - 1 : size;
}
inline float float_of(int64_t number) {
  const uint32_t sign = number < 0 ? 0x80000000u : 0;
  return std::bit_cast<float>(static_cast<uint32_t>(number < 0 ? -number - 1 : number) | sign);
}

// Every stride-th float from number first to number last.
struct FloatRange {
  int64_t first, last;
  uint64_t stride;

  uint64_t size() const { return static_cast<uint64_t>(last - first) / stride + 1; }
  float operator[](uint64_t i) const { return float_of(first + static_cast<int64_t>(i * stride)); }
};

// Every stride-th float of [lo, hi]; with a stride above 1 also the 2^14 nearest to lo, hi and what is hard, on either
// side.
inline std::vector<FloatRange> float_ranges(float lo, float hi, float hard, uint64_t stride) {
  const int64_t first = number_of(lo), last = number_of(hi);
  std::vector<FloatRange> ranges = {{first, last, stride}};
  if (stride == 1) return ranges;
  constexpr int64_t kAround = 1 << 14;
  for (const float center : {lo, hi, hard}) {
    const int64_t at = number_of(center);
    ranges.push_back({std::max(first, at - kAround), std::min(last, at + kAround), 1});
  }
  return ranges;
}

}  // namespace lanewise::verify
