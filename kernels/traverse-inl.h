// One ray at a time through an 8-wide Bvh, its node's children in the lanes; and what decides, for a vector of rays,
// which of them enter it at all.
#if defined(LANEWISE_KERNELS_TRAVERSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_TRAVERSE_INL_H_
#undef LANEWISE_KERNELS_TRAVERSE_INL_H_
#else
#define LANEWISE_KERNELS_TRAVERSE_INL_H_
#endif

#include <bit>
#include <limits>
#include <utility>

#include "core/bvh.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

using DChild = hn::CappedTag<float, kBvhWidth>;

// A direction's components are at least this share of the largest, so that every reciprocal is finite and no slab makes
// a NaN; a ray bent so little strays far less than kSlabSlack.
constexpr float kLeastSlope = 0x1p-40f;
// Boxes grow, as the ray sees them, by this share of the largest distance and coordinate in play. It covers the
// rounding of the slab distances, plane * rcp - origin * rcp, and that of the triangle test: a ray that the test lets
// pass on one side of an edge must enter the box of the triangle on the other (Woop, Benthin & Wald 2013, sec. 3.3).
constexpr float kSlabSlack = 0x1p-20f;
// 1 + 2 gamma(3) for the far planes (Ize, Robust BVH Ray Traversal, JCGT 2(2), 2013).
constexpr float kFarScale = 1.0f + 6 * 0x1p-24f + 0x1p-22f;

// A vector of rays against slabs: distances are plane * rcp - near (or far) for the planes that a ray meets first (or
// last). Stored, because rays then walk one by one.
struct SlabRays {
  HWY_ALIGN float rcp[3][kLanes], rcp_far[3][kLanes], near[3][kLanes], far[3][kLanes];
};

// Returns which rays meet the box at a distance in [0, t_max].
HWY_INLINE MF EnterBounds(const Box& box, const Vec3& o, const Vec3& dir, VF t_max, SlabRays& rays) {
  const DF d;
  const VF origin[3] = {o.x, o.y, o.z}, slope[3] = {dir.x, dir.y, dir.z};
  const VF steepest = hn::Max(hn::Abs(dir.x), hn::Max(hn::Abs(dir.y), hn::Abs(dir.z)));
  const VF least = hn::Mul(steepest, Splat(kLeastSlope));
  VF reach = hn::Zero(d);
  HWY_UNROLL(3)
  for (int a = 0; a < 3; ++a) {
    reach = hn::Max(
        reach, hn::Max(hn::Abs(hn::Sub(Splat(box.lo[a]), origin[a])), hn::Abs(hn::Sub(Splat(box.hi[a]), origin[a]))));
    reach = hn::Max(reach, hn::Abs(origin[a]));
  }
  const VF slack = hn::Mul(reach, Splat(kSlabSlack));
  VF t_near = hn::Zero(d), t_far = t_max, finite = hn::Zero(d);
  HWY_UNROLL(3)
  for (int a = 0; a < 3; ++a) {
    const VF rcp = hn::Div(Splat(1.0f), hn::CopySign(hn::Max(hn::Abs(slope[a]), least), slope[a]));
    const VF rcp_far = hn::Mul(rcp, Splat(kFarScale));
    const VF near = hn::MulAdd(slack, hn::Abs(rcp), hn::Mul(origin[a], rcp));
    const VF far = hn::NegMulAdd(slack, hn::Abs(rcp_far), hn::Mul(origin[a], rcp_far));
    hn::Store(rcp, d, rays.rcp[a]);
    hn::Store(rcp_far, d, rays.rcp_far[a]);
    hn::Store(near, d, rays.near[a]);
    hn::Store(far, d, rays.far[a]);
    finite = hn::Add(finite, hn::Add(hn::Abs(slope[a]), hn::Add(hn::Abs(near), hn::Abs(far))));
    const VF lo = Splat(box.lo[a]), hi = Splat(box.hi[a]);
    const MF backward = hn::Lt(rcp, hn::Zero(d));
    t_near = hn::Max(t_near, hn::MulSub(hn::IfThenElse(backward, hi, lo), rcp, near));
    t_far = hn::Min(t_far, hn::MulSub(hn::IfThenElse(backward, lo, hi), rcp_far, far));
  }
  // Min and Max would hide the NaNs that other rays make of an unused child's infinite planes, and let them in.
  return hn::And(hn::Le(t_near, t_far), hn::Lt(finite, Splat(std::numeric_limits<float>::infinity())));
}

// Bit i is lane i of a mask of up to 8 lanes.
template <class D>
HWY_INLINE uint32_t MaskBits(D d, hn::Mask<D> mask) {
  uint8_t bits[8] = {};
  hn::StoreMaskBits(d, mask, bits);
  return bits[0];
}

// One of the rays, ready for nodes.
class NodeTest {
 public:
  HWY_INLINE NodeTest(const SlabRays& rays, size_t lane) {
    const DChild d;
    HWY_UNROLL(3)
    for (size_t a = 0; a < 3; ++a) {
      const size_t backward = rays.rcp[a][lane] < 0 ? 3 : 0;
      near_row_[a] = (a + backward) * kBvhWidth;
      far_row_[a] = (a + 3 - backward) * kBvhWidth;
      rcp_[a] = hn::Set(d, rays.rcp[a][lane]);
      rcp_far_[a] = hn::Set(d, rays.rcp_far[a][lane]);
      near_[a] = hn::Set(d, rays.near[a][lane]);
      far_[a] = hn::Set(d, rays.far[a][lane]);
    }
  }

  // The children met at a distance in [0, t_max] as bits; entry: distances, for those.
  HWY_INLINE uint32_t operator()(const BvhNode& node, float t_max, float* entry) const {
    const DChild d;
    const float* rows = reinterpret_cast<const float*>(&node);  // lo x y z, hi x y z
    uint32_t hits = 0;
    for (size_t i = 0; i < kBvhWidth; i += hn::Lanes(d)) {
      const auto near = [&](size_t a)
                            HWY_ATTR { return hn::MulSub(hn::Load(d, rows + near_row_[a] + i), rcp_[a], near_[a]); };
      const auto far = [&](size_t a)
                           HWY_ATTR { return hn::MulSub(hn::Load(d, rows + far_row_[a] + i), rcp_far_[a], far_[a]); };
      const VChild t_near = hn::Max(hn::Max(near(0), near(1)), hn::Max(near(2), hn::Zero(d)));
      const VChild t_far = hn::Min(hn::Min(far(0), far(1)), hn::Min(far(2), hn::Set(d, t_max)));
      hn::Store(t_near, d, entry + i);
      hits |= MaskBits(d, hn::Le(t_near, t_far)) << i;
    }
    return hits;
  }

 private:
  using VChild = hn::Vec<DChild>;
  VChild rcp_[3], rcp_far_[3], near_[3], far_[3];
  size_t near_row_[3], far_row_[3];
};

// Visits, nearest first, the leaves that the ray may meet at a distance of t_max or less; leaf(block) may lower t_max.
template <class Leaf>
HWY_INLINE void WalkNearestFirst(const Bvh& bvh, const SlabRays& rays, size_t lane, const float& t_max, Leaf& leaf) {
  struct Waiting {
    uint32_t child;
    float entry;
  };
  const NodeTest test(rays, lane);
  Waiting stack[kBvhStackSize];
  size_t depth = 0;
  uint32_t child = 0;
  for (;;) {
    if (child & kLeafBit) {
      leaf(leaf_block(child));
    } else {
      const BvhNode& node = bvh.nodes[child];
      HWY_ALIGN float entry[kBvhWidth];
      uint32_t hits = test(node, t_max, entry);
      if (hits != 0) {
        uint32_t i = static_cast<uint32_t>(std::countr_zero(hits));
        hits &= hits - 1;
        Waiting nearest{node.child[i], entry[i]};
        // The farther ones are put onto the stack where they belong, the farthest of this node lowest.
        const size_t base = depth;
        while (hits != 0) {
          i = static_cast<uint32_t>(std::countr_zero(hits));
          hits &= hits - 1;
          Waiting next{node.child[i], entry[i]};
          if (next.entry < nearest.entry) std::swap(next, nearest);
          size_t at = depth++;
          for (; at > base && stack[at - 1].entry < next.entry; --at) stack[at] = stack[at - 1];
          stack[at] = next;
        }
        child = nearest.child;
        continue;
      }
    }
    do {
      if (depth == 0) return;
      --depth;
    } while (stack[depth].entry > t_max);
    child = stack[depth].child;
  }
}

// Visits the leaves that the ray may meet within t_max, in no order, until leaf(block) returns true. Returns whether one
// did.
template <class Leaf>
HWY_INLINE bool WalkUntil(const Bvh& bvh, const SlabRays& rays, size_t lane, float t_max, Leaf& leaf) {
  const NodeTest test(rays, lane);
  uint32_t stack[kBvhStackSize];
  size_t depth = 0;
  uint32_t child = 0;
  for (;;) {
    if (child & kLeafBit) {
      if (leaf(leaf_block(child))) return true;
    } else {
      const BvhNode& node = bvh.nodes[child];
      HWY_ALIGN float entry[kBvhWidth];
      for (uint32_t hits = test(node, t_max, entry); hits != 0; hits &= hits - 1) {
        stack[depth++] = node.child[std::countr_zero(hits)];
      }
    }
    if (depth == 0) return false;
    child = stack[--depth];
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
