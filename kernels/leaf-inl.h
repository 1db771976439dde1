// One ray against the block of a tree's leaf, a primitive in each lane.
#if defined(LANEWISE_KERNELS_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_LEAF_INL_H_
#undef LANEWISE_KERNELS_LEAF_INL_H_
#else
#define LANEWISE_KERNELS_LEAF_INL_H_
#endif

#include <limits>
#include <span>

#include "core/plan.h"
#include "kernels/simd-inl.h"
#include "kernels/sphere-inl.h"
#include "kernels/traverse-inl.h"
#include "kernels/triangle-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

using DLeaf = hn::CappedTag<float, kLeafWidth>;
using VLeaf = hn::Vec<DLeaf>;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
// Primitives compare as signed integers: there are less than 2^31, and kNoPrim becomes -1, which beats none of them.
constexpr int32_t kNoHit = static_cast<int32_t>(kNoPrim);

// A ray against triangles.
struct alignas(32) TriangleRay {
  float o[3];  // in the shear's order of axes
  float s_x, s_y, s_z;
  uint32_t axis[2];  // bytes from a vertex to its first and second coordinate in the shear's order
  // The third's are what is left.
  static constexpr uint32_t kAxisBytes = kLeafWidth * sizeof(float);
};

using TriangleRays = Transposed<sizeof(TriangleRay) / 16>;

HWY_INLINE TriangleRays MakeTriangleRays(const Rays& rays) {
  const DU du;
  const Shear shear = MakeShear(rays.d);
  const Vec3& o = rays.o;
  const auto x_major = hn::RebindMask(du, shear.x_major), y_major = hn::RebindMask(du, shear.y_major);
  const VU x = hn::Zero(du), y = hn::Set(du, TriangleRay::kAxisBytes), z = hn::Set(du, 2 * TriangleRay::kAxisBytes);
  TriangleRays out;
  out.Set(0, hn::IfThenElse(shear.x_major, o.z, o.x), hn::IfThenElse(shear.y_major, o.z, o.y),
          hn::IfThenElse(shear.x_major, o.x, hn::IfThenElse(shear.y_major, o.y, o.z)), shear.s_x);
  out.Set(1, shear.s_y, shear.s_z, AsFloat(hn::IfThenElse(x_major, z, x)), AsFloat(hn::IfThenElse(y_major, z, y)));
  return out;
}

// Lanes i .. of a block, relative to a ray's origin.
struct BlockVertices {
  VLeaf x[3], y[3], z[3];

  HWY_INLINE BlockVertices(const TriangleBlock& block, const TriangleRay& ray, size_t i) {
    const char* base = reinterpret_cast<const char*>(&block);
    const uint32_t last_axis = 3 * TriangleRay::kAxisBytes - ray.axis[0] - ray.axis[1];
    HWY_UNROLL(3)
    for (size_t k = 0; k < 3; ++k, base += 3 * TriangleRay::kAxisBytes) {
      x[k] = Coordinate(base + ray.axis[0], i, ray.o[0]);
      y[k] = Coordinate(base + ray.axis[1], i, ray.o[1]);
      z[k] = Coordinate(base + last_axis, i, ray.o[2]);
    }
  }

 private:
  static HWY_INLINE VLeaf Coordinate(const char* row, size_t i, float origin) {
    const DLeaf d;
    return hn::Sub(hn::Load(d, reinterpret_cast<const float*>(row) + i), hn::Set(d, origin));
  }
};

// What a block's triangles say to a ray, one a lane; see TriangleTest.
struct BlockTest {
  HWY_ALIGN float depth[kLeafWidth], det[kLeafWidth], v[kLeafWidth], w[kLeafWidth];

  template <class Test>
  HWY_INLINE void Store(const Test& test, size_t i) {
    const DLeaf d;
    hn::Store(test.depth, d, depth + i);
    hn::Store(test.det, d, det + i);
    hn::Store(test.weight[1], d, v + i);
    hn::Store(test.weight[2], d, w + i);
  }
};

// Returns which triangles are hit within t_max, give or take some rounding, as bits; from bit kLeafWidth on, which are
// doubtful.
HWY_INLINE uint32_t TestBlockQuickly(const TriangleBlock& block, const TriangleRay& ray, float t_max, BlockTest& test) {
  const DLeaf d;
  uint32_t bits = 0;
  for (size_t i = 0; i < kLeafWidth; i += hn::Lanes(d)) {
    BlockVertices at(block, ray, i);
    const QuickTest<DLeaf> quick =
        TestQuickly(d, at.x, at.y, at.z, hn::Set(d, ray.s_x), hn::Set(d, ray.s_y), hn::Set(d, ray.s_z), t_max);
    test.Store(quick, i);
    bits |= MaskBits(d, quick.hit) << i | MaskBits(d, quick.doubtful) << (kLeafWidth + i);
  }
  return bits;
}

// After TestBlockQuickly: returns which of its triangles the ray meets, at any distance, and makes sure of the doubtful.
HWY_INLINE uint32_t MakeSure(const TriangleBlock& block, const TriangleRay& ray, uint32_t bits, BlockTest& test) {
  if (HWY_LIKELY(bits >> kLeafWidth == 0)) return bits;
  const DLeaf d;
  const hn::Mask<DLeaf> all = hn::Eq(hn::Zero(d), hn::Zero(d));
  uint32_t inside = 0;
  for (size_t i = 0; i < kLeafWidth; i += hn::Lanes(d)) {
    BlockVertices at(block, ray, i);
    const TriangleTest<DLeaf> exact =
        TestTriangle(d, all, at.x, at.y, at.z, hn::Set(d, ray.s_x), hn::Set(d, ray.s_y), hn::Set(d, ray.s_z));
    test.Store(exact, i);
    inside |= MaskBits(d, exact.inside) << i;
  }
  return (bits | bits >> kLeafWidth) & inside;
}

// A ray against spheres.
struct alignas(32) SphereRay {
  float o[3], a;  // a = d.d
  float d[3], inv_a;
};

using SphereRays = Transposed<sizeof(SphereRay) / 16>;

HWY_INLINE SphereRays MakeSphereRays(const Rays& rays) {
  const VF a = Dot(rays.d, rays.d);
  SphereRays out;
  out.Set(0, rays.o.x, rays.o.y, rays.o.z, a);
  out.Set(1, rays.d.x, rays.d.y, rays.d.z, hn::Div(Splat(1.0f), a));
  return out;
}

// Distances in units of the direction, +inf for misses.
struct SphereTest {
  HWY_ALIGN float t[kLeafWidth];
};

// Returns which of the block's spheres are hit within t_max, as bits.
HWY_INLINE uint32_t TestBlock(const SphereBlock& block, const SphereRay& ray, float t_max, SphereTest& test) {
  const DLeaf d;
  uint32_t bits = 0;
  for (size_t i = 0; i < kLeafWidth; i += hn::Lanes(d)) {
    VLeaf f[3], dir[3];
    HWY_UNROLL(3)
    for (int k = 0; k < 3; ++k) {
      f[k] = hn::Sub(hn::Set(d, ray.o[k]), hn::Load(d, block.center[k] + i));
      dir[k] = hn::Set(d, ray.d[k]);
    }
    const VLeaf t = SphereRoot(d, f, dir, hn::Set(d, ray.a), hn::Set(d, ray.inv_a), hn::Load(d, block.radius + i));
    hn::Store(t, d, test.t + i);
    bits |= MaskBits(d, hn::Le(t, hn::Set(d, t_max))) << i;
  }
  return bits;
}

// The triangles of a tree's leaves, for a Flight: all but what is done with a hit.
class TriangleLeaves {
 public:
  using Block = TriangleBlock;
  using Ray = TriangleRay;
  using Test = BlockTest;

  explicit TriangleLeaves(const Plan& plan) : blocks_(plan.triangle_blocks) {}

  std::span<const Block> Blocks() const { return blocks_; }
  static HWY_INLINE TriangleRays Make(const Rays& rays) { return MakeTriangleRays(rays); }
  static HWY_INLINE uint32_t MayHit(const Ray& ray, const Block& block, float t_max, Test& test) {
    return TestBlockQuickly(block, ray, t_max, test);
  }

 private:
  std::span<const Block> blocks_;
};

// The spheres of a tree's leaves, for a Flight: all but what is done with a hit.
class SphereLeaves {
 public:
  using Block = SphereBlock;
  using Ray = SphereRay;
  using Test = SphereTest;

  explicit SphereLeaves(const Plan& plan) : blocks_(plan.sphere_blocks) {}

  std::span<const Block> Blocks() const { return blocks_; }
  static HWY_INLINE SphereRays Make(const Rays& rays) { return MakeSphereRays(rays); }
  static HWY_INLINE uint32_t MayHit(const Ray& ray, const Block& block, float t_max, Test& test) {
    return TestBlock(block, ray, t_max, test);
  }

 private:
  std::span<const Block> blocks_;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
