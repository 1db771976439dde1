// Groups of references, and how one is parted in two. Internal to the builder.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/bvh_binary.h"

namespace lanewise::bvh {

// References that one thread takes at a time.
constexpr uint32_t kChunk = 16384;

// References that lie together.
struct Group {
  uint32_t first = 0;
  uint32_t count = 0;
  Bounds4 box;
  Bounds4 centroids;

  void add(const Ref& r) {
    box.add(r.box);
    centroids.add(r.centroid(), r.centroid());
    ++count;
  }
  void add(const Group& g) {
    box.add(g.box);
    centroids.add(g.centroids);
    count += g.count;
  }
};

struct Sides {
  Group left, right;
};

// Puts first the references that `goes_left` holds for.
template <class GoesLeft>
Sides partition(std::span<Ref> refs, uint32_t first, const GoesLeft& goes_left) {
  Sides sides;
  size_t i = 0, j = refs.size();
  for (;;) {
    for (; i < j && goes_left(refs[i]); ++i) sides.left.add(refs[i]);
    for (; i < j && !goes_left(refs[j - 1]); --j) sides.right.add(refs[j - 1]);
    if (i >= j) break;
    std::swap(refs[i], refs[j - 1]);
  }
  sides.left.first = first;
  sides.right.first = first + sides.left.count;
  return sides;
}

// The same by all threads: each chunk by itself, then the wrong ones of both sides change places.
template <class GoesLeft>
Sides partition_in_parallel(std::span<Ref> refs, uint32_t first, const GoesLeft& goes_left) {
  const size_t chunks = (refs.size() + kChunk - 1) / kChunk;
  std::vector<Sides> parts(chunks);
  tbb::parallel_for(size_t{0}, chunks, [&](size_t c) {
    const size_t begin = c * kChunk;
    parts[c] = partition(refs.subspan(begin, std::min<size_t>(kChunk, refs.size() - begin)),
                         static_cast<uint32_t>(begin), goes_left);
  });
  Sides sides;
  for (const Sides& part : parts) {
    sides.left.add(part.left);
    sides.right.add(part.right);
  }
  // Right ones below the middle, left ones above it: as many of each.
  const uint32_t middle = sides.left.count;
  const auto end_of = [](const Group& g) { return g.first + g.count; };
  uint32_t low = 0, high = 0;
  size_t c_low = 0, c_high = 0;
  const auto next = [&](uint32_t& at, size_t& c, Group Sides::*side, uint32_t from, uint32_t to) {
    for (; c < chunks; ++c) {
      const Group& g = parts[c].*side;
      at = std::max({at, g.first, from});
      if (at < std::min(end_of(g), to)) return true;
    }
    return false;
  };
  const uint32_t all = static_cast<uint32_t>(refs.size());
  while (next(low, c_low, &Sides::right, 0, middle) && next(high, c_high, &Sides::left, middle, all)) {
    std::swap(refs[low++], refs[high++]);
  }
  sides.left.first = first;
  sides.right.first = first + middle;
  return sides;
}

}  // namespace lanewise::bvh
