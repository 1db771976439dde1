#include "core/bvh_binary.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#include <atomic>

#include "core/bvh_partition.h"

namespace lanewise::bvh {
namespace {

constexpr int32_t kBins = 16;
// From here down a node is split at the best of all places between two neighbours, not of bins.
constexpr uint32_t kSweep = 24;
// As few as these stay together, half a block. Going on to single references makes trees no better.
constexpr uint32_t kFewRefs = 4;
// Subtrees below this size are built by the thread that reaches them, nodes above the other one by all threads.
constexpr uint32_t kParallelSubtree = 4096;
constexpr uint32_t kParallelNode = 65536;

// Leaves are tested by the block, so that a block that is full costs no more than one that is not.
float blocks_of(uint32_t refs) { return static_cast<float>((refs + kLeafWidth - 1) / kLeafWidth); }

uint32_t ceil_log2(uint32_t n) { return static_cast<uint32_t>(std::bit_width(n - 1)); }

struct Split {
  float cost = kInf;  // area times blocks, summed over both sides
  int axis = -1;
  uint32_t at = 0;  // the first bin, or the first in order, on the right
};

// Maps centroids to bins; the same expression decides where a reference is counted and where it goes.
struct BinMap {
  Float4 lo;
  Float4 scale{};

  explicit BinMap(const Bounds4& centroids) : lo(centroids.lo) {
    for (int a = 0; a < 3; ++a) {
      const float extent = centroids.hi[a] - centroids.lo[a];
      // Extents whose quotient overflows are as good as none.
      scale[a] =
          extent > kBins * std::numeric_limits<float>::min() ? static_cast<float>(kBins) * (1 - 0x1p-20f) / extent : 0;
    }
  }
  // The mask changes nothing but what comes of centroids that overflow.
  Int4 bins(const Ref& r) const {
    return __builtin_convertvector((r.centroid() - lo) * scale, Int4) & (Int4{} + (kBins - 1));
  }
};

struct Bins {
  Bounds4 box[3][kBins];
  uint32_t count[3][kBins] = {};

  void add(std::span<const Ref> refs, const BinMap& map) {
    for (const Ref& r : refs) {
      const Int4 bins = map.bins(r);
      for (int a = 0; a < 3; ++a) {
        const auto bin = static_cast<uint32_t>(bins[a]);
        box[a][bin].add(r.box);
        ++count[a][bin];
      }
    }
  }
  void add(const Bins& other) {
    for (int a = 0; a < 3; ++a) {
      for (uint32_t b = 0; b < kBins; ++b) {
        box[a][b].add(other.box[a][b]);
        count[a][b] += other.count[a][b];
      }
    }
  }
  Split best_split(const BinMap& map) const;
};

Split Bins::best_split(const BinMap& map) const {
  Split best;
  for (int a = 0; a < 3; ++a) {
    if (map.scale[a] == 0) continue;
    float right_cost[kBins];
    Bounds4 side;
    uint32_t n = 0;
    for (uint32_t b = kBins - 1; b > 0; --b) {
      side.add(box[a][b]);
      n += count[a][b];
      right_cost[b] = n == 0 ? kInf : side.area() * blocks_of(n);
    }
    side = Bounds4();
    n = 0;
    for (uint32_t b = 1; b < kBins; ++b) {
      side.add(box[a][b - 1]);
      n += count[a][b - 1];
      if (n == 0) continue;
      const float cost = side.area() * blocks_of(n) + right_cost[b];
      if (cost < best.cost) best = {cost, a, b};
    }
  }
  return best;
}

class Builder {
 public:
  Builder(std::span<Ref> refs, uint32_t max_depth)
      : refs_(refs), nodes_(std::make_unique_for_overwrite<BinaryNode[]>(2 * refs.size())), max_depth_(max_depth) {
    Group all = tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, refs.size(), kChunk), Group(),
        [&](const tbb::blocked_range<size_t>& r, Group g) {
          for (const Ref& ref : refs.subspan(r.begin(), r.size())) g.add(ref);
          return g;
        },
        [](Group a, const Group& b) {
          a.add(b);
          return a;
        });
    build(0, all, 0);
  }

  BinaryTree tree() { return {std::move(nodes_), next_node_}; }

 private:
  std::span<Ref> refs_of(const Group& g) { return refs_.subspan(g.first, g.count); }

  void build(uint32_t index, const Group& group, uint32_t depth) {
    BinaryNode& node = nodes_[index];
    for (int a = 0; a < 3; ++a) node.lo[a] = group.box.lo[a];
    for (int a = 0; a < 3; ++a) node.hi[a] = group.box.hi[a];
    node.first = group.first;
    node.count = group.count;
    node.left = 0;
    if (group.count <= kFewRefs) return;
    // Halving from here on must still fit under the bound.
    const bool halve = depth + ceil_log2(group.count) >= max_depth_;
    const Sides sides = halve ? split_in_half(group) : group.count <= kSweep ? sweep(group) : split_by_bins(group);
    const uint32_t left = next_node_.fetch_add(2, std::memory_order_relaxed);
    node.left = left;
    node.right = left + 1;
    const auto build_left = [&] { build(left, sides.left, depth + 1); };
    const auto build_right = [&] { build(left + 1, sides.right, depth + 1); };
    if (group.count > kParallelSubtree) {
      tbb::parallel_invoke(build_left, build_right);
    } else {
      build_left();
      build_right();
    }
  }

  Sides split_by_bins(const Group& group) {
    const std::span<Ref> refs = refs_of(group);
    const BinMap map(group.centroids);
    const auto add = [&](const tbb::blocked_range<size_t>& r, Bins bins) {
      bins.add(refs.subspan(r.begin(), r.size()), map);
      return bins;
    };
    const auto join = [](Bins a, const Bins& b) {
      a.add(b);
      return a;
    };
    const bool parallel = group.count > kParallelNode;
    const tbb::blocked_range<size_t> all(0, refs.size(), kChunk);
    const Split split = (parallel ? tbb::parallel_reduce(all, Bins(), add, join) : add(all, Bins())).best_split(map);
    if (split.axis < 0) return split_in_half(group);
    const auto goes_left = [&](const Ref& r) { return static_cast<uint32_t>(map.bins(r)[split.axis]) < split.at; };
    return parallel ? partition_in_parallel(refs, group.first, goes_left) : partition(refs, group.first, goes_left);
  }

  // Tries all places.
  Sides sweep(const Group& group) {
    const std::span<Ref> refs = refs_of(group);
    uint8_t order[3][kSweep];
    Split best;
    for (int a = 0; a < 3; ++a) {
      if (!(group.centroids.hi[a] > group.centroids.lo[a])) continue;
      float key[kSweep];
      for (uint32_t i = 0; i < group.count; ++i) {
        const float centroid = refs[i].centroid()[a];
        uint32_t at = i;
        for (; at > 0 && centroid < key[at - 1]; --at) {
          key[at] = key[at - 1];
          order[a][at] = order[a][at - 1];
        }
        key[at] = centroid;
        order[a][at] = static_cast<uint8_t>(i);
      }
      float right_cost[kSweep];
      Bounds4 side;
      for (uint32_t i = group.count - 1; i > 0; --i) {
        side.add(refs[order[a][i]].box);
        right_cost[i] = side.area() * blocks_of(group.count - i);
      }
      side = Bounds4();
      for (uint32_t i = 1; i < group.count; ++i) {
        side.add(refs[order[a][i - 1]].box);
        const float cost = side.area() * blocks_of(i) + right_cost[i];
        if (cost < best.cost) best = {cost, a, i};
      }
    }
    if (best.axis < 0) return split_in_half(group);
    Ref sorted[kSweep];
    for (uint32_t i = 0; i < group.count; ++i) sorted[i] = refs[order[best.axis][i]];
    std::copy_n(sorted, group.count, refs.begin());
    return divide(group, best.at);
  }

  // For centroids that no plane parts, areas that overflow and nodes near the depth bound.
  Sides split_in_half(const Group& group) {
    int axis = 0;
    for (int a = 1; a < 3; ++a) {
      if (group.centroids.hi[a] - group.centroids.lo[a] > group.centroids.hi[axis] - group.centroids.lo[axis]) axis = a;
    }
    const std::span<Ref> refs = refs_of(group);
    std::nth_element(refs.begin(), refs.begin() + group.count / 2, refs.end(), [axis](const Ref& a, const Ref& b) {
      return a.centroid()[axis] != b.centroid()[axis] ? a.centroid()[axis] < b.centroid()[axis] : a.prim() < b.prim();
    });
    return divide(group, group.count / 2);
  }

  // The first left_count to the left.
  Sides divide(const Group& group, uint32_t left_count) {
    Sides sides;
    for (const Ref& r : refs_of(group).first(left_count)) sides.left.add(r);
    for (const Ref& r : refs_of(group).subspan(left_count)) sides.right.add(r);
    sides.left.first = group.first;
    sides.right.first = group.first + left_count;
    return sides;
  }

  std::span<Ref> refs_;
  std::unique_ptr<BinaryNode[]> nodes_;  // pages that no node comes to lie on are never touched
  std::atomic<uint32_t> next_node_ = 1;
  uint32_t max_depth_;
};

}  // namespace

BinaryTree build_binary(std::span<Ref> refs, uint32_t max_depth) { return Builder(refs, max_depth).tree(); }

}  // namespace lanewise::bvh
