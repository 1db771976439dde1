// One ray in an 8-wide Bvh: what decides whether it enters the tree, and its test of a node.
#if defined(LANEWISE_KERNELS_TRAVERSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_TRAVERSE_INL_H_
#undef LANEWISE_KERNELS_TRAVERSE_INL_H_
#else
#define LANEWISE_KERNELS_TRAVERSE_INL_H_
#endif

#include <bit>
#include <cstring>
#include <limits>

#include "core/bvh.h"
#include "kernels/compress-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

using DChild = hn::CappedTag<float, kBvhWidth>;
using VChild = hn::Vec<DChild>;

// A direction's components are at least this share of the largest, so that every reciprocal is finite and no slab makes
// a NaN; a ray bent so little strays far less than kSlabSlack.
constexpr float kLeastSlope = 0x1p-40f;
// Boxes grow, as the ray sees them, by this share of the largest distance and coordinate in play. It covers the
// rounding of the slab distances, plane * rcp - origin * rcp, and that of the triangle test: a ray that the test lets
// pass on one side of an edge must enter the box of the triangle on the other (Woop, Benthin & Wald 2013, sec. 3.3).
constexpr float kSlabSlack = 0x1p-20f;
// 1 + 2 gamma(3) for the far planes (Ize, Robust BVH Ray Traversal, JCGT 2(2), 2013).
constexpr float kFarScale = 1.0f + 6 * 0x1p-24f + 0x1p-22f;

// A vector of rays against slabs: a plane's distance is plane * rcp - near for the planes that a ray meets first, and
// (plane * rcp - far) * kFarScale for those that it meets last.
struct SlabRays {
  VF rcp[3], near[3], far[3];
  VF size;  // finite for rays of numbers alone

  // bounds: of all boxes that the rays will be tested against.
  HWY_INLINE SlabRays(const Box& bounds, const Vec3& o, const Vec3& dir) {
    const VF origin[3] = {o.x, o.y, o.z}, slope[3] = {dir.x, dir.y, dir.z};
    const VF steepest = hn::Max(hn::Abs(dir.x), hn::Max(hn::Abs(dir.y), hn::Abs(dir.z)));
    const VF least = hn::Mul(steepest, Splat(kLeastSlope));
    VF reach = hn::Zero(DF());
    HWY_UNROLL(3)
    for (int a = 0; a < 3; ++a) {
      reach = hn::Max(reach, hn::Max(hn::Abs(hn::Sub(Splat(bounds.lo[a]), origin[a])),
                                     hn::Abs(hn::Sub(Splat(bounds.hi[a]), origin[a]))));
      reach = hn::Max(reach, hn::Abs(origin[a]));
    }
    const VF slack = hn::Mul(reach, Splat(kSlabSlack));
    size = hn::Zero(DF());
    HWY_UNROLL(3)
    for (int a = 0; a < 3; ++a) {
      rcp[a] = hn::Div(Splat(1.0f), hn::CopySign(hn::Max(hn::Abs(slope[a]), least), slope[a]));
      const VF around = hn::Mul(slack, hn::Abs(rcp[a]));
      near[a] = hn::MulAdd(origin[a], rcp[a], around);
      far[a] = hn::MulSub(origin[a], rcp[a], around);
      size = hn::Add(size, hn::Add(hn::Abs(slope[a]), hn::Add(hn::Abs(near[a]), hn::Abs(far[a]))));
    }
  }

  HWY_INLINE MF Backward(int axis) const { return hn::Lt(rcp[axis], hn::Zero(DF())); }

  // Which rays meet the box at a distance in [0, t_max].
  HWY_INLINE MF Meet(const Box& box, VF t_max) const {
    VF t_near = hn::Zero(DF()), t_far = Splat(std::numeric_limits<float>::infinity());
    HWY_UNROLL(3)
    for (int a = 0; a < 3; ++a) {
      const MF backward = Backward(a);
      const VF lo = Splat(box.lo[a]), hi = Splat(box.hi[a]);
      t_near = hn::Max(t_near, hn::MulSub(hn::IfThenElse(backward, hi, lo), rcp[a], near[a]));
      t_far = hn::Min(t_far, hn::MulSub(hn::IfThenElse(backward, lo, hi), rcp[a], far[a]));
    }
    t_far = hn::Min(hn::Mul(t_far, Splat(kFarScale)), t_max);
    // Min and Max would hide the NaNs that other rays make of an unused child's infinite planes, and let them in.
    return hn::And(hn::Le(t_near, t_far), hn::Lt(size, Splat(std::numeric_limits<float>::infinity())));
  }
};

// Bit i is lane i of a mask of up to 8 lanes.
template <class D>
HWY_INLINE uint32_t MaskBits(D d, hn::Mask<D> mask) {
  uint8_t bits[8] = {};
  hn::StoreMaskBits(d, mask, bits);
  return bits[0];
}

// One ray in flight, ready for nodes.
struct alignas(64) NodeRay {
  float rcp[3], t_max;
  float near[3], unused0;
  float far[3], unused1;
  uint32_t order;  // slots of hit children are pushed in the order 0 ^ order .. 7 ^ order: farthest first
  uint32_t index;  // of the ray, as the caller counts
  uint32_t child;  // the next step: as BvhNode has it, or what stands for the end
  uint32_t top;    // of the ray's part of the stack: the first free word
};

// Structs of 4 * kQuads words, one a lane, made from vectors of their words.
template <size_t kQuads>
struct Transposed {
  HWY_ALIGN float words[kQuads][4 * hn::MaxLanes(DF())];

  HWY_INLINE void Set(size_t quad, VF a, VF b, VF c, VF d) { hn::StoreInterleaved4(a, b, c, d, DF(), words[quad]); }
  HWY_INLINE void Get(size_t lane, void* to) const {
    for (size_t q = 0; q < kQuads; ++q) std::memcpy(static_cast<char*>(to) + 16 * q, words[q] + 4 * lane, 16);
  }
};
HWY_INLINE VF AsFloat(VU words) { return hn::BitCast(DF(), words); }

// A vector of rays that walk a tree, and their indices as the caller counts.
struct Rays {
  Vec3 o, d;
  VF t_max;
  VU index;
};

using NodeRays = Transposed<sizeof(NodeRay) / 16>;

HWY_INLINE NodeRays MakeNodeRays(const Box& bounds, const Rays& rays) {
  const DU du;
  const VF zero = hn::Zero(DF());
  const SlabRays slabs(bounds, rays.o, rays.d);
  VU order = hn::Set(du, kBvhWidth - 1);
  HWY_UNROLL(3)
  for (int a = 0; a < 3; ++a) {
    order = hn::Sub(order, hn::IfThenElseZero(hn::RebindMask(du, slabs.Backward(a)), hn::Set(du, 1u << a)));
  }
  NodeRays out;
  out.Set(0, slabs.rcp[0], slabs.rcp[1], slabs.rcp[2], rays.t_max);
  out.Set(1, slabs.near[0], slabs.near[1], slabs.near[2], zero);
  out.Set(2, slabs.far[0], slabs.far[1], slabs.far[2], zero);
  out.Set(3, AsFloat(order), AsFloat(rays.index), zero, zero);
  return out;
}

#ifndef LANEWISE_KERNELS_TRAVERSE_ONCE
#define LANEWISE_KERNELS_TRAVERSE_ONCE
}  // namespace HWY_NAMESPACE

// Bit j of masks[x][mask] is bit j ^ x of mask.
struct ExclusiveOrTable {
  alignas(64) uint8_t masks[8][256];
};
constexpr ExclusiveOrTable make_exclusive_or_table() {
  ExclusiveOrTable table{};
  for (int x = 0; x < 8; ++x) {
    for (int mask = 0; mask < 256; ++mask) {
      for (int j = 0; j < 8; ++j) table.masks[x][mask] |= static_cast<uint8_t>((mask >> (j ^ x) & 1) << j);
    }
  }
  return table;
}
inline constexpr ExclusiveOrTable kExclusiveOrTable = make_exclusive_or_table();

// Bytes from a node to the planes that a ray meets first (x, y, z) and last, by its NodeRay::order.
struct PlaneRows {
  uint32_t near[3], far[3], unused[2];
};
struct PlaneRowsTable {
  alignas(64) PlaneRows rows[8];
};
constexpr PlaneRowsTable make_plane_rows_table() {
  PlaneRowsTable table{};
  for (uint32_t order = 0; order < 8; ++order) {
    for (uint32_t a = 0; a < 3; ++a) {
      const bool forward = order >> a & 1;
      table.rows[order].near[a] = (forward ? a : a + 3) * kBvhWidth * sizeof(float);
      table.rows[order].far[a] = (forward ? a + 3 : a) * kBvhWidth * sizeof(float);
    }
  }
  return table;
}
inline constexpr PlaneRowsTable kPlaneRowsTable = make_plane_rows_table();

namespace HWY_NAMESPACE {
#endif

// A ray against the children of a node.
class NodeTest {
 public:
  HWY_INLINE NodeTest(const BvhNode& node, const NodeRay& ray)
      : node_(node), ray_(ray), rows_(kPlaneRowsTable.rows[ray.order]) {}

  // Those that it meets at a distance in [0, t_max] as bits; entries: where, one a child.
  HWY_INLINE uint32_t Hits(float* HWY_RESTRICT entries) const {
    const DChild d;
    uint32_t hits = 0;
    for (size_t i = 0; i < kBvhWidth; i += hn::Lanes(d)) {
      const VChild enter = hn::Max(hn::Max(Near(0, i), Near(1, i)), hn::Max(Near(2, i), hn::Zero(d)));
      const VChild leave = hn::Mul(hn::Min(hn::Min(Far(0, i), Far(1, i)), Far(2, i)), hn::Set(d, kFarScale));
      hn::Store(enter, d, entries + i);
      hits |= MaskBits(d, hn::Le(enter, hn::Min(leave, hn::Set(d, ray_.t_max)))) << i;
    }
    return hits;
  }

 private:
  HWY_INLINE VChild Row(uint32_t bytes, size_t i) const {
    return hn::Load(DChild(), reinterpret_cast<const float*>(reinterpret_cast<const char*>(&node_) + bytes) + i);
  }
  HWY_INLINE VChild Near(uint32_t a, size_t i) const {
    const DChild d;
    return hn::MulSub(Row(rows_.near[a], i), hn::Set(d, ray_.rcp[a]), hn::Set(d, ray_.near[a]));
  }
  HWY_INLINE VChild Far(uint32_t a, size_t i) const {
    const DChild d;
    return hn::MulSub(Row(rows_.far[a], i), hn::Set(d, ray_.rcp[a]), hn::Set(d, ray_.far[a]));
  }

  const BvhNode& node_;
  const NodeRay& ray_;
  const PlaneRows& rows_;
};

// Pushes the children that are hit, the nearest last, and if the walk is one for the nearest, where the ray enters them.
// Writes up to kBvhWidth words past what it returns: their number.
template <bool kNearest>
HWY_INLINE uint32_t PushChildren(const BvhNode& node, uint32_t hits, uint32_t order, const float* from_entries,
                                 uint32_t* HWY_RESTRICT children, float* HWY_RESTRICT entries) {
  const DChild d;
  const hn::RebindToUnsigned<DChild> du;
  if constexpr (hn::MaxLanes(DChild()) == kBvhWidth) {
    const uint32_t ordered = kNearest ? kExclusiveOrTable.masks[order][hits] : hits;
    const hn::Rebind<uint8_t, DChild> bytes;
    auto slots = hn::PromoteTo(du, hn::LoadU(bytes, kCompressTable.rows[ordered]));
    if (kNearest) slots = hn::Xor(slots, hn::Set(du, order));
    hn::StoreU(hn::TableLookupLanes(hn::Load(du, node.child), hn::IndicesFromVec(du, slots)), du, children);
    if (kNearest) hn::StoreU(hn::TableLookupLanes(hn::Load(d, from_entries), hn::IndicesFromVec(d, slots)), d, entries);
    return static_cast<uint32_t>(std::popcount(hits));
  } else {
    uint32_t n = 0;
    for (uint32_t j = 0; j < kBvhWidth; ++j) {
      const uint32_t slot = j ^ order;
      children[n] = node.child[slot];
      if (kNearest) entries[n] = from_entries[slot];
      n += hits >> slot & 1;
    }
    return n;
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
