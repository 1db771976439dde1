// An 8-wide bounding volume hierarchy over boxes; what is in the boxes is the caller's business.
#pragma once

#include <cstdint>
#include <vector>

#include "core/types.h"

namespace lanewise {

constexpr uint32_t kNoPrim = 0xFFFFFFFFu;
constexpr uint32_t kBvhWidth = 8;   // children of a node
constexpr uint32_t kLeafWidth = 8;  // primitives of a leaf block, tested together

struct Box {
  float lo[3];
  float hi[3];
};

// One node: the boxes of its children in SoA, and where they are. Unused children have lo = +inf, hi = -inf, so no ray
// enters them. 224 bytes of bounds and children on 64-byte lines.
//
// The place of a child says where it is: bit a of its index is set for those on the upper side of axis a. A ray whose
// octant has bit a set where its direction's component a is negative thus meets the children roughly front to back in
// the order octant ^ 0, octant ^ 1, ... octant ^ 7 (Ylitie, Karras & Laine, Efficient Incoherent Ray Traversal on GPUs
// Through Compressed Wide BVHs, HPG 2017, sec. 3.3). A hint only; unused children may be anywhere.
struct alignas(64) BvhNode {
  float lo[3][kBvhWidth];
  float hi[3][kBvhWidth];
  uint32_t child[kBvhWidth];  // a node's index, or kLeafBit | the index of a leaf's block
};

constexpr uint32_t kLeafBit = 0x80000000u;
constexpr uint32_t leaf_block(uint32_t child) { return child & ~kLeafBit; }

struct Bvh {
  AlignedVector<BvhNode> nodes;      // nodes[0] is the root; empty for no primitives
  std::vector<uint32_t> leaf_prims;  // kLeafWidth a block: indices into the boxes given, kNoPrim where it is short
  Box bounds{};                      // of everything
  uint32_t depth = 0;                // inner nodes on the longest way down; at most kMaxBvhDepth
};

// What a traversal's stack must hold: 7 siblings a level.
constexpr uint32_t kMaxBvhDepth = 32;
constexpr uint32_t kBvhStackSize = 7 * kMaxBvhDepth + 8;

// Builds a binary tree by SAH with bins (Wald, On Fast Construction of SAH-Based Bounding Volume Hierarchies, RT 2007),
// moves its large subtrees to better places (Bittner, Hapala & Havran 2013), and then makes of it the wide tree of least
// cost (Ylitie et al. 2017, sec. 3.2), by all threads. The boxes must be finite with lo <= hi, and less than 2^29; their
// memory is given back early. Deterministic: a function of the boxes alone.
Bvh build_bvh(std::vector<Box> boxes);

}  // namespace lanewise
