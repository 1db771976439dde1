// How many paths each call of a stage got: a histogram in steps of an eighth of an octave.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace lanewise {

// The histogram's buckets: lengths below 2 kParts have one each, longer ones share kParts between a power of two and the next.
namespace queue_bucket {

constexpr uint32_t kParts = 8;

constexpr uint32_t of(uint32_t paths) {
  if (paths < 2 * kParts) return paths;
  const uint32_t shift = static_cast<uint32_t>(std::bit_width(paths) - std::bit_width(kParts));
  return shift * kParts + (paths >> shift);
}

// The least length in it.
constexpr uint32_t first(uint32_t bucket) {
  if (bucket < 2 * kParts) return bucket;
  const uint32_t shift = bucket / kParts - 1;
  return (bucket - shift * kParts) << shift;
}

static_assert(of(15) == 15 && of(16) == 16 && of(17) == 16 && of(18) == 17 && of(31) == 23 && of(32) == 24);
static_assert(first(15) == 15 && first(16) == 16 && first(17) == 18 && first(24) == 32);

}  // namespace queue_bucket

class QueueLengths {
 public:
  static constexpr uint32_t kMostPaths = 1 << 20;  // the largest wave

  void add(uint32_t paths) {
    ++calls_[queue_bucket::of(paths)];
    min_ = std::min(min_, paths);
    max_ = std::max(max_, paths);
  }

  void add(const QueueLengths& other) {
    for (size_t b = 0; b < calls_.size(); ++b) calls_[b] += other.calls_[b];
    min_ = std::min(min_, other.min_);
    max_ = std::max(max_, other.max_);
  }

  uint32_t min() const { return std::min(min_, max_); }  // 0 if there was no call
  uint32_t max() const { return max_; }

  // The length that a share q of the calls do not exceed, to within a sixteenth; exact below 16 and for q = 0 and 1.
  uint32_t quantile(double q) const {
    uint64_t all = 0, below = 0;
    for (const uint64_t n : calls_) all += n;
    const auto rank = static_cast<uint64_t>(std::ceil(q * static_cast<double>(all)));  // 1 for the shortest
    if (rank <= 1) return min();
    for (uint32_t b = 0; b < calls_.size(); ++b) {
      below += calls_[b];
      if (below >= rank) return std::clamp((queue_bucket::first(b) + queue_bucket::first(b + 1) - 1) / 2, min(), max_);
    }
    return max_;
  }

 private:
  std::array<uint64_t, queue_bucket::of(kMostPaths) + 1> calls_{};
  uint32_t min_ = UINT32_MAX;
  uint32_t max_ = 0;
};

}  // namespace lanewise
