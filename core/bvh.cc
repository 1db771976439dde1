#include "core/bvh.h"

#include "core/bvh_binary.h"

namespace lanewise {

Bvh build_bvh(std::vector<Box> boxes) {
  if (boxes.empty()) return {};
  std::vector<bvh::Ref> refs;
  refs.reserve(boxes.size());
  for (uint32_t i = 0; i < boxes.size(); ++i) refs.emplace_back(boxes[i], i);
  boxes = std::vector<Box>();
  // The binary tree may be deeper: a wide node makes some three of its levels one.
  bvh::BinaryTree tree = bvh::build_binary(refs, 3 * kMaxBvhDepth);
  bvh::optimize(tree);
  Bvh bvh = bvh::collapse(tree, refs);
  // A wide tree is never deeper than its binary one.
  if (bvh.depth > kMaxBvhDepth) bvh = bvh::collapse(bvh::build_binary(refs, kMaxBvhDepth), refs);
  return bvh;
}

}  // namespace lanewise
