#include "core/bvh.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace lanewise {
namespace {

constexpr uint32_t kBins = 16;
// Of a binary split, in units of the test of one block. Three levels of the binary tree become one of the wide tree.
constexpr float kSplitCost = 0.5f;
// Subtrees below this size are built by the thread that reaches them.
constexpr uint32_t kParallelPrims = 4096;
// Of the binary tree. Collapsing makes three levels one, so that no sensible input comes near kMaxBvhDepth.
constexpr uint32_t kBinaryDepth = 3 * kMaxBvhDepth;

constexpr float kInf = std::numeric_limits<float>::infinity();

// A box padded to whole vectors of four, which the compiler then uses.
struct Bounds4 {
  float lo[4] = {kInf, kInf, kInf, kInf};
  float hi[4] = {-kInf, -kInf, -kInf, -kInf};

  void add(const float* other_lo, const float* other_hi) {
    for (int a = 0; a < 4; ++a) lo[a] = std::min(lo[a], other_lo[a]);
    for (int a = 0; a < 4; ++a) hi[a] = std::max(hi[a], other_hi[a]);
  }
  void add(const Bounds4& b) { add(b.lo, b.hi); }
  // Half the surface; 0 for nothing.
  float area() const {
    const float x = hi[0] - lo[0], y = hi[1] - lo[1], z = hi[2] - lo[2];
    return x < 0 ? 0 : x * y + y * z + z * x;
  }
};

struct Ref {
  Bounds4 box;
  uint32_t prim;

  // Twice the centre: only comparisons and differences of it are ever used.
  float centroid(int axis) const { return box.lo[axis] + box.hi[axis]; }
};

// Node i's left child is i + 1. A subtree of n references owns the 2 n - 1 slots from its root on, so that tasks write
// to places that depend on the boxes alone.
struct BinaryNode {
  Bounds4 box;
  uint32_t first = 0;  // reference
  uint32_t count = 0;
  uint32_t right = 0;  // 0: a leaf
};

float blocks_of(uint32_t prims) { return static_cast<float>((prims + kLeafWidth - 1) / kLeafWidth); }

uint32_t ceil_log2(uint32_t n) { return static_cast<uint32_t>(std::bit_width(n - 1)); }

struct Split {
  float cost = kInf;  // area times blocks, summed over both sides
  int axis = -1;
  uint32_t bin = 0;  // the first on the right
};

// Maps centroids to bins; the same expression decides where a reference is counted and where it goes.
struct BinMap {
  float lo[3];
  float scale[3];

  BinMap(const Bounds4& centroids) {
    for (int a = 0; a < 3; ++a) {
      lo[a] = centroids.lo[a];
      const float extent = centroids.hi[a] - centroids.lo[a];
      // Extents whose quotient overflows are as good as none.
      scale[a] =
          extent > kBins * std::numeric_limits<float>::min() ? static_cast<float>(kBins) * (1 - 0x1p-20f) / extent : 0;
    }
  }
  uint32_t bin(const Ref& r, int axis) const {
    return std::min(kBins - 1, static_cast<uint32_t>((r.centroid(axis) - lo[axis]) * scale[axis]));
  }
};

// Where a node's children go, see BvhNode: of all assignments the one whose children lie farthest, summed, towards the
// corners that their slots stand for. Boxes beyond those given fill the slots left.
std::array<uint8_t, kBvhWidth> assign_slots(std::span<const Bounds4> boxes) {
  constexpr uint32_t kSets = 1 << kBvhWidth;
  // Small enough that nothing below overflows.
  constexpr float kScale = 0x1p-6f;
  float mean[3] = {};
  const auto center = [](const Bounds4& box, int a) { return kScale * box.lo[a] + kScale * box.hi[a]; };
  for (int a = 0; a < 3; ++a) {
    for (const Bounds4& box : boxes) mean[a] += center(box, a) / static_cast<float>(boxes.size());
  }
  // Of the first i boxes in the i slots of a set: the best sum, and the slot of the last.
  float best[kSets];
  uint8_t last[kSets] = {};
  std::fill_n(best, kSets, -kInf);
  best[0] = 0;
  for (uint32_t set = 0; set < kSets; ++set) {
    const size_t i = static_cast<size_t>(std::popcount(set));
    if (i >= kBvhWidth) break;
    for (uint8_t slot = 0; slot < kBvhWidth; ++slot) {
      if (set >> slot & 1) continue;
      float sum = best[set];
      for (int a = 0; a < 3 && i < boxes.size(); ++a) {
        const float offset = center(boxes[i], a) - mean[a];
        sum += slot >> a & 1 ? offset : -offset;
      }
      const uint32_t next = set | 1u << slot;
      if (sum > best[next]) {
        best[next] = sum;
        last[next] = slot;
      }
    }
  }
  std::array<uint8_t, kBvhWidth> slots;
  for (uint32_t set = kSets - 1; set != 0; set &= ~(1u << last[set])) {
    slots[static_cast<size_t>(std::popcount(set)) - 1] = last[set];
  }
  return slots;
}

class Builder {
 public:
  Builder(std::span<const Box> boxes, uint32_t max_depth)
      : refs_(boxes.size()), nodes_(2 * boxes.size()), max_depth_(max_depth) {
    for (uint32_t i = 0; i < boxes.size(); ++i) {
      std::copy_n(boxes[i].lo, 3, refs_[i].box.lo);
      std::copy_n(boxes[i].hi, 3, refs_[i].box.hi);
      refs_[i].box.lo[3] = refs_[i].box.hi[3] = 0;
      refs_[i].prim = i;
    }
    build(0, 0, static_cast<uint32_t>(boxes.size()), 0);
  }

  Bvh collapse() const {
    Bvh bvh;
    std::copy_n(nodes_[0].box.lo, 3, bvh.bounds.lo);
    std::copy_n(nodes_[0].box.hi, 3, bvh.bounds.hi);
    collapse(0, 1, bvh);
    return bvh;
  }

 private:
  void build(uint32_t index, uint32_t first, uint32_t count, uint32_t depth) {
    BinaryNode& node = nodes_[index];
    node.first = first;
    node.count = count;
    Bounds4 centroids;
    for (uint32_t i = first; i < first + count; ++i) {
      const Ref& r = refs_[i];
      node.box.add(r.box);
      float c[4];
      for (int a = 0; a < 4; ++a) c[a] = r.box.lo[a] + r.box.hi[a];
      centroids.add(c, c);
    }
    if (count == 1) return;

    const BinMap map(centroids);
    // Halving from here on must still fit under the bound.
    const bool halve = depth + ceil_log2(count) >= max_depth_;
    const Split split = halve ? Split{} : best_split(first, count, map);
    const float area = node.box.area();
    if (count <= kLeafWidth && !(split.cost + kSplitCost * area < blocks_of(count) * area)) return;

    const uint32_t middle = split.axis < 0 ? halve_range(first, count, centroids) : partition(first, count, map, split);
    const uint32_t left = index + 1, left_count = middle - first;
    const uint32_t right = index + 2 * left_count;
    node.right = right;
    const auto build_left = [&] { build(left, first, left_count, depth + 1); };
    const auto build_right = [&] { build(right, middle, count - left_count, depth + 1); };
    if (count > kParallelPrims) {
      tbb::parallel_invoke(build_left, build_right);
    } else {
      build_left();
      build_right();
    }
  }

  Split best_split(uint32_t first, uint32_t count, const BinMap& map) const {
    struct Bin {
      Bounds4 box;
      uint32_t count = 0;
    };
    std::array<std::array<Bin, kBins>, 3> bins;
    for (uint32_t i = first; i < first + count; ++i) {
      for (int a = 0; a < 3; ++a) {
        Bin& bin = bins[a][map.bin(refs_[i], a)];
        bin.box.add(refs_[i].box);
        ++bin.count;
      }
    }
    Split best;
    for (int a = 0; a < 3; ++a) {
      if (map.scale[a] == 0) continue;
      float right_cost[kBins];
      Bounds4 box;
      uint32_t n = 0;
      for (uint32_t b = kBins - 1; b > 0; --b) {
        box.add(bins[a][b].box);
        n += bins[a][b].count;
        right_cost[b] = n == 0 ? kInf : box.area() * blocks_of(n);
      }
      box = Bounds4();
      n = 0;
      for (uint32_t b = 1; b < kBins; ++b) {
        box.add(bins[a][b - 1].box);
        n += bins[a][b - 1].count;
        if (n == 0) continue;
        const float cost = box.area() * blocks_of(n) + right_cost[b];
        if (cost < best.cost) best = {cost, a, b};
      }
    }
    return best;
  }

  uint32_t partition(uint32_t first, uint32_t count, const BinMap& map, const Split& split) {
    const auto begin = refs_.begin() + first;
    const auto middle =
        std::partition(begin, begin + count, [&](const Ref& r) { return map.bin(r, split.axis) < split.bin; });
    return static_cast<uint32_t>(middle - refs_.begin());
  }

  // For centroids that no plane parts, areas that overflow and nodes near the depth bound.
  uint32_t halve_range(uint32_t first, uint32_t count, const Bounds4& centroids) {
    int axis = 0;
    for (int a = 1; a < 3; ++a) {
      if (centroids.hi[a] - centroids.lo[a] > centroids.hi[axis] - centroids.lo[axis]) axis = a;
    }
    const auto begin = refs_.begin() + first;
    std::nth_element(begin, begin + count / 2, begin + count, [axis](const Ref& a, const Ref& b) {
      return a.centroid(axis) != b.centroid(axis) ? a.centroid(axis) < b.centroid(axis) : a.prim < b.prim;
    });
    return first + count / 2;
  }

  // Makes one wide node of the binary subtree at `root` and recurses. Returns its index.
  uint32_t collapse(uint32_t root, uint32_t depth, Bvh& bvh) const {
    uint32_t children[kBvhWidth] = {root};
    uint32_t n = 1;
    while (n < kBvhWidth) {
      // Opens the child that most rays enter.
      uint32_t open = kBvhWidth;
      float largest = -1;
      for (uint32_t i = 0; i < n; ++i) {
        const BinaryNode& child = nodes_[children[i]];
        if (child.right != 0 && child.box.area() > largest) {
          largest = child.box.area();
          open = i;
        }
      }
      if (open == kBvhWidth) break;
      const uint32_t opened = children[open];
      children[open] = opened + 1;
      children[n++] = nodes_[opened].right;
    }

    bvh.depth = std::max(bvh.depth, depth);
    const uint32_t index = static_cast<uint32_t>(bvh.nodes.size());
    bvh.nodes.emplace_back();
    Bounds4 boxes[kBvhWidth];
    for (uint32_t i = 0; i < n; ++i) boxes[i] = nodes_[children[i]].box;
    const std::array<uint8_t, kBvhWidth> slots = assign_slots(std::span(boxes, n));
    for (uint32_t i = 0; i < kBvhWidth; ++i) {
      for (int a = 0; a < 3; ++a) {
        bvh.nodes[index].lo[a][slots[i]] = boxes[i].lo[a];
        bvh.nodes[index].hi[a][slots[i]] = boxes[i].hi[a];
      }
      bvh.nodes[index].child[slots[i]] = 0;
    }
    for (uint32_t i = 0; i < n; ++i) {
      const BinaryNode& child = nodes_[children[i]];
      const uint32_t reference = child.right == 0 ? add_leaf(child, bvh) : collapse(children[i], depth + 1, bvh);
      bvh.nodes[index].child[slots[i]] = reference;
    }
    return index;
  }

  uint32_t add_leaf(const BinaryNode& leaf, Bvh& bvh) const {
    const uint32_t block = static_cast<uint32_t>(bvh.leaf_prims.size()) / kLeafWidth;
    for (uint32_t i = 0; i < kLeafWidth; ++i) {
      bvh.leaf_prims.push_back(i < leaf.count ? refs_[leaf.first + i].prim : kNoPrim);
    }
    return kLeafBit | block;
  }

  std::vector<Ref> refs_;
  std::vector<BinaryNode> nodes_;
  uint32_t max_depth_;
};

}  // namespace

Bvh build_bvh(std::span<const Box> boxes) {
  if (boxes.empty()) return {};
  Bvh bvh = Builder(boxes, kBinaryDepth).collapse();
  // A wide tree is never deeper than its binary one.
  if (bvh.depth > kMaxBvhDepth) bvh = Builder(boxes, kMaxBvhDepth).collapse();
  return bvh;
}

}  // namespace lanewise
