// Rays through an 8-wide Bvh, many in flight at once. Each is a small state machine: its next step is a node or a leaf
// block. All rays whose next step is a node take it, then all whose next step is a leaf, and so on. A step has no branch
// that depends on what the ray meets (hit children are pushed by one permutation, leaves that miss fall through), so
// that the processor overlaps the steps of different rays, where a ray alone would wait for memory and mispredicted
// branches. What the next step needs is fetched while the other rays take theirs.
#if defined(LANEWISE_KERNELS_FLIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_FLIGHT_INL_H_
#undef LANEWISE_KERNELS_FLIGHT_INL_H_
#else
#define LANEWISE_KERNELS_FLIGHT_INL_H_
#endif

#include <algorithm>

#include "core/bvh.h"
#include "hwy/cache_control.h"
#include "kernels/compress-inl.h"
#include "kernels/simd-inl.h"
#include "kernels/traverse-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// Rays in flight. More hide more latency, until they and what they wait for outgrow the first-level cache.
constexpr size_t kFlight = 32;

// Those of a batch of rays that must walk a tree, side by side.
template <size_t kCapacity>
class RayList {
 public:
  // Adds those of the rays first, first + 1, .. that are wanted and meet the tree's bounds within t_max.
  HWY_INLINE void Add(const Bvh& tree, size_t first, const Vec3& o, const Vec3& d, VF t_max, MF wanted) {
    if (tree.nodes.empty()) return;
    const DU du;
    const MF enters = hn::And(wanted, SlabRays(tree.bounds, o, d).Meet(tree.bounds, t_max));
    const Compressor compress(hn::RebindMask(du, enters));
    const VU words[kWords] = {
        hn::BitCast(du, o.x), hn::BitCast(du, o.y), hn::BitCast(du, o.z),   hn::BitCast(du, d.x),
        hn::BitCast(du, d.y), hn::BitCast(du, d.z), hn::BitCast(du, t_max), hn::Iota(du, static_cast<uint32_t>(first))};
    HWY_UNROLL(kWords)
    for (size_t w = 0; w < kWords; ++w) hn::StoreU(compress(words[w]), du, words_[w] + size_);
    size_ += hn::CountTrue(DF(), enters);
  }

  size_t size() const { return size_; }
  void clear() { size_ = 0; }

  // Rays at .., of which those past the end are anything.
  HWY_INLINE Rays Load(size_t at) const {
    const auto word = [&](size_t w) HWY_ATTR { return hn::LoadU(DU(), words_[w] + at); };
    return {{AsFloat(word(0)), AsFloat(word(1)), AsFloat(word(2))},
            {AsFloat(word(3)), AsFloat(word(4)), AsFloat(word(5))},
            AsFloat(word(6)),
            word(7)};
  }

 private:
  static constexpr size_t kWords = 8;
  HWY_ALIGN uint32_t words_[kWords][kCapacity + kLanes];
  size_t size_ = 0;
};

// Walks rays through the tree. Leaves is what a walk looks for:
//   Block                       what a leaf holds
//   Ray                         what leaves need of a ray
//   kNearest                    whether t_max shrinks and the order of visits matters
//   Blocks()                    all of them
//   Make(rays)                  what leaves need of a vector of rays, as Transposed
//   Test                        what is kept of a block's test until the step's second half
//   MayHit(Ray&, Block&, t_max, Test&) which of the block's primitives may be hit within t_max: not 0 if any
//   Visit(Ray&, Block&, hits, Test&, NodeRay&) -> bool: whether t_max has shrunk or, if !kNearest, the ray is done
template <class Leaves>
class Flight {
 public:
  HWY_INLINE Flight(const Bvh& bvh, const Leaves& leaves)
      : leaves_(leaves),
        bounds_(bvh.bounds),
        nodes_(bvh.nodes.data()),
        base_{reinterpret_cast<uintptr_t>(bvh.nodes.data()), reinterpret_cast<uintptr_t>(leaves.Blocks().data())},
        landing_(kLeafBit | static_cast<uint32_t>(leaves.Blocks().size())),
        stride_(7 * bvh.depth + 1 + kBvhWidth) {
    for (uint32_t i = 0; i < kFlight; ++i) landed_[i] = i;
  }

  template <size_t kCapacity>
  HWY_INLINE void Walk(const RayList<kCapacity>& list) {
    const size_t lanes = hn::Lanes(DF());
    for (size_t next = 0;;) {
      for (; next < list.size() && free_ >= lanes; next += lanes) {
        Start(list.Load(next), std::min(lanes, list.size() - next));
      }
      if (at_nodes_ + at_leaves_ == 0) return;
      StepNodes();
      StepLeaves();
    }
  }

 private:
  using Block = typename Leaves::Block;
  static constexpr bool kNearest = Leaves::kNearest;
  static constexpr size_t kStackWords = kFlight * (kBvhStackSize + kBvhWidth);

  HWY_INLINE void Start(const Rays& rays, size_t count) {
    const NodeRays node_rays = MakeNodeRays(bounds_, rays);
    const auto leaf_rays = leaves_.Make(rays);
    for (size_t k = 0; k < count; ++k) {
      const uint32_t slot = landed_[--free_];
      const uint32_t bottom = static_cast<uint32_t>(slot * stride_);
      node_rays.Get(k, &rays_[slot]);
      leaf_rays.Get(k, &leaf_rays_[slot]);
      rays_[slot].child = 0;
      rays_[slot].top = bottom + 1;
      children_[bottom] = landing_;
      node_queue_[at_nodes_++] = slot;
    }
  }

  // Queues a ray for its next step: in all queues, and keeps it in one. Without a branch, which would be mispredicted as
  // often as not.
  HWY_INLINE void Send(uint32_t slot, uint32_t child, size_t& at_nodes, size_t& at_leaves, size_t& free) {
    const uint32_t leaf = child >> 31, end = child == landing_;
    node_queue_[at_nodes] = slot;
    at_nodes += leaf ^ 1;
    leaf_queue_[at_leaves] = slot;
    at_leaves += leaf - end;
    landed_[free] = slot;
    free += end;
    // A block of triangles has five lines, a node four. Past the end nothing is read, only asked for.
    const uintptr_t address = base_[leaf] + leaf_block(child) * size_[leaf];
    HWY_UNROLL(5)
    for (size_t line = 0; line < 5; ++line) hwy::Prefetch(reinterpret_cast<const char*>(address + 64 * line));
  }

  // A step is taken in two halves, each short enough for the processor to have several rays' at work at once.
  HWY_NOINLINE void StepNodes() {
    const size_t count = at_nodes_;
    for (size_t i = 0; i < count; ++i) {
      const NodeRay& ray = rays_[node_queue_[i]];
      hits_[i] = NodeTest(nodes_[ray.child], ray).Hits(hit_entries_ + kBvhWidth * i);
    }
    size_t at_nodes = 0, at_leaves = at_leaves_, free = free_;
    for (size_t i = 0; i < count; ++i) {
      const uint32_t slot = node_queue_[i];
      NodeRay& ray = rays_[slot];
      const size_t top = ray.top;
      const size_t pushed = PushChildren<kNearest>(nodes_[ray.child], hits_[i], ray.order, hit_entries_ + kBvhWidth * i,
                                                   children_ + top, entries_ + (kNearest ? top : 0));
      ray.top = static_cast<uint32_t>(top + pushed - 1);
      Send(slot, ray.child = children_[top + pushed - 1], at_nodes, at_leaves, free);
    }
    at_nodes_ = at_nodes, at_leaves_ = at_leaves, free_ = free;
  }

  HWY_NOINLINE void StepLeaves() {
    const size_t count = at_leaves_;
    for (size_t i = 0; i < count; ++i) {
      const uint32_t slot = leaf_queue_[i];
      const NodeRay& ray = rays_[slot];
      hits_[i] = leaves_.MayHit(leaf_rays_[slot], leaves_.Blocks()[leaf_block(ray.child)], ray.t_max, tests_[i]);
    }
    size_t at_nodes = at_nodes_, at_leaves = 0, free = free_;
    for (size_t i = 0; i < count; ++i) {
      const uint32_t slot = leaf_queue_[i];
      NodeRay& ray = rays_[slot];
      if (HWY_UNLIKELY(hits_[i] != 0)) Visit(slot, i);
      Send(slot, ray.child = children_[--ray.top], at_nodes, at_leaves, free);
    }
    at_nodes_ = at_nodes, at_leaves_ = at_leaves, free_ = free;
  }

  HWY_NOINLINE void Visit(uint32_t slot, size_t i) {
    NodeRay& ray = rays_[slot];
    if (leaves_.Visit(leaf_rays_[slot], leaves_.Blocks()[leaf_block(ray.child)], hits_[i], tests_[i], ray)) Prune(slot);
  }

  // After a hit, what is farther need not be visited; of any hit, nothing.
  HWY_INLINE void Prune(uint32_t slot) {
    uint32_t kept = static_cast<uint32_t>(slot * stride_) + 1;
    if (kNearest) {
      for (uint32_t i = kept; i < rays_[slot].top; ++i) {
        children_[kept] = children_[i];
        entries_[kept] = entries_[i];
        kept += entries_[i] <= rays_[slot].t_max;
      }
    }
    rays_[slot].top = kept;
  }

  const Leaves& leaves_;
  const Box& bounds_;
  const BvhNode* nodes_;
  uintptr_t base_[2];  // addresses of nodes and of blocks
  size_t size_[2] = {sizeof(BvhNode), sizeof(Block)};
  uint32_t landing_;  // stands for the end where a child would stand: a leaf that is none
  size_t stride_;     // words of the stacks a ray
  size_t at_nodes_ = 0, at_leaves_ = 0, free_ = kFlight;
  uint32_t node_queue_[kFlight + 1], leaf_queue_[kFlight + 1], landed_[kFlight + 1];
  uint32_t hits_[kFlight];  // of a half-taken step, by place in the queue
  HWY_ALIGN float hit_entries_[kFlight * kBvhWidth];
  typename Leaves::Test tests_[kFlight];
  NodeRay rays_[kFlight];
  typename Leaves::Ray leaf_rays_[kFlight];
  // What a ray has still to visit, the next one on top, landing_ at the bottom; and where it enters them.
  HWY_ALIGN uint32_t children_[kStackWords];
  HWY_ALIGN float entries_[kNearest ? kStackWords : 1];
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
