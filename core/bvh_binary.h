// The binary tree that a Bvh is collapsed from. Internal to the builder.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "core/bvh.h"

namespace lanewise::bvh {

constexpr float kInf = std::numeric_limits<float>::infinity();

// GCC's and Clang's vectors: three axes and a lane to spare.
using Float4 = float __attribute__((vector_size(16)));
using Int4 = int32_t __attribute__((vector_size(16)));

constexpr Float4 splat(float x) { return Float4{x, x, x, x}; }

struct Bounds4 {
  Float4 lo = splat(kInf);
  Float4 hi = splat(-kInf);

  void add(Float4 other_lo, Float4 other_hi) {
    lo = other_lo < lo ? other_lo : lo;
    hi = hi < other_hi ? other_hi : hi;
  }
  void add(const Bounds4& b) { add(b.lo, b.hi); }
  // Half the surface; 0 for nothing.
  float area() const {
    const Float4 size = hi - lo;
    return size[0] < 0 ? 0 : size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
  }
};

// What the builder sorts: a primitive. The index travels in the box's spare lane, dressed as a normal
// number, for arithmetic on all lanes.
struct Ref {
  Bounds4 box;

  Ref() = default;
  Ref(const Box& b, uint32_t prim)
      : box{{b.lo[0], b.lo[1], b.lo[2], std::bit_cast<float>(prim | kNormal)}, {b.hi[0], b.hi[1], b.hi[2], 0}} {}
  uint32_t prim() const { return std::bit_cast<uint32_t>(float{box.lo[3]}) & ~kNormal; }
  // Twice the centre: only comparisons and differences of it are ever used.
  Float4 centroid() const { return box.lo + box.hi; }

 private:
  static constexpr uint32_t kNormal = 0x40000000;
};

struct BinaryNode {
  float lo[3], hi[3];
  uint32_t first;                             // a leaf's first reference; the others follow
  uint32_t count;                             // references of all leaves below
  uint32_t left, right;                       // children; left is 0 for a leaf
  std::array<uint8_t, kBvhWidth> left_share;  // see bvh_collapse.cc
  uint32_t wide;                              // its place in the wide tree, as in BvhNode::child

  float area() const {
    const float x = hi[0] - lo[0], y = hi[1] - lo[1], z = hi[2] - lo[2];
    return x * y + y * z + z * x;
  }
};

struct BinaryTree {
  std::unique_ptr<BinaryNode[]> nodes;  // nodes[0] is the root; where the others are depends on the threads' timing
  size_t size = 0;                      // nodes
};

// Splits by SAH down to a few references, but no deeper than max_depth levels below the root. Sorts refs so that those
// of a node lie together. The tree's shape and the order of refs are functions of refs alone.
BinaryTree build_binary(std::span<Ref> refs, uint32_t max_depth);

// Lowers the tree's SAH cost by moving large subtrees. References of an inner node then no longer lie together.
void optimize(BinaryTree& tree);

// Makes the wide tree of least SAH cost that the binary one holds.
Bvh collapse(const BinaryTree& tree, std::span<const Ref> refs);

}  // namespace lanewise::bvh
