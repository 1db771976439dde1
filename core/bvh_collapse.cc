// From two children a node to eight: Ylitie, Karras & Laine, Efficient Incoherent Ray Traversal on GPUs Through
// Compressed Wide BVHs, HPG 2017, sec. 3.2 and 3.3.
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include "core/bvh_binary.h"

namespace lanewise::bvh {
namespace {

// Eight boxes are tested in about the time of eight triangles.
constexpr float kNodeCost = 1;
constexpr float kLeafCost = 1;
constexpr uint32_t kParallelSubtree = 4096;
constexpr uint8_t kFewer = 0;

// [i]: the least cost of a binary subtree as at most i + 1 children of a wide node, times the area of the root.
using Costs = std::array<float, kBvhWidth>;

// Where a node's children go, see BvhNode: of all assignments the one whose children lie farthest, summed, towards the
// corners that their slots stand for.
std::array<uint8_t, kBvhWidth> assign_slots(std::span<const BinaryNode* const> children) {
  constexpr uint32_t kSets = 1 << kBvhWidth;
  static constexpr auto kSize = [] {
    std::array<uint8_t, kSets> size{};
    for (uint32_t set = 0; set < kSets; ++set) size[set] = static_cast<uint8_t>(std::popcount(set));
    return size;
  }();
  // Small enough that nothing below overflows.
  constexpr float kScale = 0x1p-6f;
  float center[kBvhWidth][3] = {}, mean[3] = {};
  for (size_t i = 0; i < children.size(); ++i) {
    for (int a = 0; a < 3; ++a) {
      center[i][a] = kScale * children[i]->lo[a] + kScale * children[i]->hi[a];
      mean[a] += center[i][a] / static_cast<float>(children.size());
    }
  }
  float gain[kBvhWidth][kBvhWidth] = {};
  for (size_t i = 0; i < children.size(); ++i) {
    const float x = center[i][0] - mean[0], y = center[i][1] - mean[1], z = center[i][2] - mean[2];
    for (uint32_t slot = 0; slot < kBvhWidth; ++slot) {
      gain[i][slot] = (slot & 1 ? x : -x) + (slot & 2 ? y : -y) + (slot & 4 ? z : -z);
    }
  }
  // Of the first i children in the i slots of a set: the best sum, and the slot of the last. Slots left over are filled
  // with children that do not matter.
  float best[kSets];
  uint8_t last[kSets];
  std::fill_n(best, kSets, -kInf);
  best[0] = 0;
  for (uint32_t set = 0; set < kSets - 1; ++set) {
    for (uint32_t slot = 0; slot < kBvhWidth; ++slot) {
      if (set >> slot & 1) continue;
      const uint32_t next = set | 1u << slot;
      const float sum = best[set] + gain[kSize[set]][slot];
      if (sum > best[next]) {
        best[next] = sum;
        last[next] = static_cast<uint8_t>(slot);
      }
    }
  }
  std::array<uint8_t, kBvhWidth> slots;
  for (uint32_t set = kSets - 1; set != 0; set &= ~(1u << last[set])) slots[kSize[set] - 1u] = last[set];
  return slots;
}

class Collapser {
 public:
  Collapser(const BinaryTree& tree, std::span<const Ref> refs) : nodes_(tree.nodes.get()), refs_(refs) {}

  Bvh run() {
    std::copy_n(nodes_[0].lo, 3, bvh_.bounds.lo);
    std::copy_n(nodes_[0].hi, 3, bvh_.bounds.hi);
    find_costs(nodes_[0]);
    place(nodes_[0], 0);
    bvh_.nodes.resize(sources_.size());
    bvh_.leaf_prims.resize(size_t{blocks_} * kLeafWidth);
    tbb::parallel_for(size_t{0}, sources_.size(), [&](size_t i) { fill(bvh_.nodes[i], *sources_[i]); });
    return std::move(bvh_);
  }

 private:
  // Also sets left_share[i]: of i + 1 children, how many the left side gets at the least cost, or kFewer if i children
  // cost no more. left_share[0] is for the one child: kFewer for a leaf, else how many of a node's eight the left gets.
  Costs find_costs(BinaryNode& node) {
    const float leaf = kLeafCost * node.area();
    Costs costs;
    if (node.left == 0) {
      costs.fill(leaf);
      node.left_share.fill(kFewer);
      return costs;
    }
    Costs left, right;
    const auto find_left = [&] { left = find_costs(nodes_[node.left]); };
    const auto find_right = [&] { right = find_costs(nodes_[node.right]); };
    if (node.count > kParallelSubtree) {
      tbb::parallel_invoke(find_left, find_right);
    } else {
      find_left();
      find_right();
    }
    for (uint32_t i = 1; i < kBvhWidth; ++i) {
      costs[i] = left[0] + right[i - 1];
      node.left_share[i] = 1;
      for (uint32_t k = 1; k < i; ++k) {
        const float cost = left[k] + right[i - 1 - k];
        if (!(cost < costs[i])) continue;
        costs[i] = cost;
        node.left_share[i] = static_cast<uint8_t>(k + 1);
      }
    }
    const float inner = costs[kBvhWidth - 1] + kNodeCost * node.area();
    const bool is_leaf = node.count <= kLeafWidth && !(inner < leaf);
    costs[0] = is_leaf ? leaf : inner;
    node.left_share[0] = is_leaf ? kFewer : node.left_share[kBvhWidth - 1];
    for (uint32_t i = 1; i < kBvhWidth; ++i) {
      if (costs[i] < costs[i - 1]) continue;
      costs[i] = costs[i - 1];
      node.left_share[i] = kFewer;
    }
    return costs;
  }

  struct Children {
    BinaryNode* node[kBvhWidth];
    uint32_t count = 0;
  };

  // Adds those that the subtree becomes if it may be at most n children.
  void gather(BinaryNode& node, uint32_t n, Children& children) const {
    while (n > 1 && node.left_share[n - 1] == kFewer) --n;
    if (n == 1) {
      children.node[children.count++] = &node;
    } else {
      gather_both(node, node.left_share[n - 1], n, children);
    }
  }
  void gather_both(BinaryNode& node, uint32_t left_share, uint32_t n, Children& children) const {
    gather(nodes_[node.left], left_share, children);
    gather(nodes_[node.right], n - left_share, children);
  }

  Children children_of(BinaryNode& node) const {
    Children children;
    if (node.left_share[0] == kFewer) {
      children.node[children.count++] = &node;  // a tree of one leaf
    } else {
      gather_both(node, node.left_share[0], kBvhWidth, children);
    }
    return children;
  }

  // Numbers nodes and blocks in depth-first order.
  void place(BinaryNode& node, uint32_t depth) {
    bvh_.depth = std::max(bvh_.depth, depth + 1);
    node.wide = static_cast<uint32_t>(sources_.size());
    sources_.push_back(&node);
    const Children children = children_of(node);
    for (uint32_t i = 0; i < children.count; ++i) {
      BinaryNode& child = *children.node[i];
      if (child.left_share[0] == kFewer) {
        child.wide = kLeafBit | blocks_++;
      } else {
        place(child, depth + 1);
      }
    }
  }

  void fill(BvhNode& out, BinaryNode& source) {
    const Children children = children_of(source);
    const auto slots = assign_slots(std::span(children.node, children.count));
    for (uint32_t i = 0; i < kBvhWidth; ++i) {
      const uint32_t slot = slots[i];
      const BinaryNode* child = i < children.count ? children.node[i] : nullptr;
      for (int a = 0; a < 3; ++a) {
        out.lo[a][slot] = child ? child->lo[a] : kInf;
        out.hi[a][slot] = child ? child->hi[a] : -kInf;
      }
      out.child[slot] = child ? child->wide : 0;
      if (child && child->wide & kLeafBit) fill_block(*child);
    }
  }

  void fill_block(const BinaryNode& leaf) {
    uint32_t* prims = &bvh_.leaf_prims[size_t{leaf_block(leaf.wide)} * kLeafWidth];
    uint32_t n = 0;
    fill_lanes(leaf, prims, n);
    std::fill(prims + n, prims + kLeafWidth, kNoPrim);
  }
  void fill_lanes(const BinaryNode& node, uint32_t* prims, uint32_t& n) const {
    if (node.left != 0) {
      fill_lanes(nodes_[node.left], prims, n);
      fill_lanes(nodes_[node.right], prims, n);
      return;
    }
    for (const Ref& ref : refs_.subspan(node.first, node.count)) prims[n++] = ref.prim();
  }

  BinaryNode* nodes_;
  std::span<const Ref> refs_;
  Bvh bvh_;
  std::vector<BinaryNode*> sources_;  // of the wide nodes
  uint32_t blocks_ = 0;
};

}  // namespace

Bvh collapse(const BinaryTree& tree, std::span<const Ref> refs) { return Collapser(tree, refs).run(); }

}  // namespace lanewise::bvh
