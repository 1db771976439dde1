// Scalar twin of kernels/traverse-inl.h: the same tree, child by child.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/bvh.h"
#include "kernels/reference/vec3.h"

namespace lanewise::reference {

template <class T>
class SlabRay {
 public:
  // bounds: of the whole tree.
  SlabRay(const Box& bounds, const Vec3<T>& o, const Vec3<T>& d) : o_(o) {
    const Vec3<T> size = glm::abs(d);
    const T least = std::max({size.x, size.y, size.z}) * T(0x1p-40);
    T reach = 0;
    for (int a = 0; a < 3; ++a) {
      rcp_[a] = 1 / std::copysign(std::max(size[a], least), d[a]);
      reach = std::max({reach, std::abs(bounds.lo[a] - o[a]), std::abs(bounds.hi[a] - o[a]), std::abs(o[a])});
    }
    slack_ = reach * T(0x1p-20);
  }

  // Whether the ray meets the box, grown by the slack, at a distance in [0, t_max]; entry: that distance.
  bool enters(const float* lo, const float* hi, size_t stride, T t_max, T& entry) const {
    if (*lo > *hi) return false;  // unused: a ray with a NaN in it would enter
    T near = 0, far = t_max;
    for (int a = 0; a < 3; ++a) {
      const T below = (lo[static_cast<size_t>(a) * stride] - slack_ - o_[a]) * rcp_[a];
      const T above = (hi[static_cast<size_t>(a) * stride] + slack_ - o_[a]) * rcp_[a];
      near = std::max(near, std::min(below, above));
      far = std::min(far, std::max(below, above));
    }
    entry = near;
    return near <= far;
  }

 private:
  Vec3<T> o_, rcp_;
  T slack_;
};

// Visits the leaves that the ray may meet at a distance of t_max or less, a node's nearest first; leaf(block) may lower
// t_max, and ends the walk by returning true. Returns whether it did.
template <class T, class Leaf>
bool walk(const Bvh& bvh, const SlabRay<T>& ray, const T& t_max, const Leaf& leaf, uint32_t child = 0) {
  if (bvh.nodes.empty()) return false;
  if (child & kLeafBit) return leaf(leaf_block(child));
  struct Entered {
    T entry;
    uint32_t child;
  };
  const BvhNode& node = bvh.nodes[child];
  Entered entered[kBvhWidth];
  size_t n = 0;
  for (size_t i = 0; i < kBvhWidth; ++i) {
    T entry;
    if (!ray.enters(&node.lo[0][i], &node.hi[0][i], kBvhWidth, t_max, entry)) continue;
    size_t at = n++;
    for (; at > 0 && entered[at - 1].entry > entry; --at) entered[at] = entered[at - 1];
    entered[at] = {entry, node.child[i]};
  }
  for (size_t i = 0; i < n && entered[i].entry <= t_max; ++i) {
    if (walk(bvh, ray, t_max, leaf, entered[i].child)) return true;
  }
  return false;
}

}  // namespace lanewise::reference
