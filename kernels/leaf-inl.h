// One ray against the blocks of a tree's leaves, a primitive in each lane.
#if defined(LANEWISE_KERNELS_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_LEAF_INL_H_
#undef LANEWISE_KERNELS_LEAF_INL_H_
#else
#define LANEWISE_KERNELS_LEAF_INL_H_
#endif

#include <limits>

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

// Rays in memory.
struct RayLanes {
  HWY_ALIGN float o[3][kLanes], d[3][kLanes];
  // The shear's constants, and which axis comes in the place of x, of y and of z.
  HWY_ALIGN float s_x[kLanes], s_y[kLanes], s_z[kLanes];
  HWY_ALIGN int32_t major[kLanes];

  HWY_INLINE void Store(const Vec3& origin, const Vec3& dir, const Shear& shear) {
    const DF df;
    StoreVec3(origin, o[0], o[1], o[2], 0);
    StoreVec3(dir, d[0], d[1], d[2], 0);
    hn::Store(shear.s_x, df, s_x);
    hn::Store(shear.s_y, df, s_y);
    hn::Store(shear.s_z, df, s_z);
    const VF axis =
        hn::IfThenElse(shear.x_major, hn::Zero(df), hn::IfThenElse(shear.y_major, Splat(1.0f), Splat(2.0f)));
    hn::Store(hn::ConvertTo(DI(), axis), DI(), major);
  }
};

// One ray against the triangles of a block.
class TriangleLeaf {
 public:
  HWY_INLINE TriangleLeaf(const Plan& plan, const RayLanes& rays, size_t lane) : blocks_(plan.triangle_blocks.data()) {
    const DLeaf d;
    const int major = rays.major[lane];
    axis_[0] = major == 0 ? 2 : 0;
    axis_[1] = major == 1 ? 2 : 1;
    axis_[2] = major;
    HWY_UNROLL(3)
    for (int k = 0; k < 3; ++k) o_[k] = hn::Set(d, rays.o[axis_[k]][lane]);
    s_x_ = hn::Set(d, rays.s_x[lane]);
    s_y_ = hn::Set(d, rays.s_y[lane]);
    s_z_ = hn::Set(d, rays.s_z[lane]);
  }

  HWY_INLINE const TriangleBlock& Block(size_t block) const { return blocks_[block]; }

  // Lanes i .. of the block.
  HWY_INLINE TriangleTest<DLeaf> Test(const TriangleBlock& block, size_t i) const {
    const DLeaf d;
    VLeaf x[3], y[3], z[3];
    HWY_UNROLL(3)
    for (int k = 0; k < 3; ++k) {
      x[k] = hn::Sub(hn::Load(d, block.v[k][axis_[0]] + i), o_[0]);
      y[k] = hn::Sub(hn::Load(d, block.v[k][axis_[1]] + i), o_[1]);
      z[k] = hn::Sub(hn::Load(d, block.v[k][axis_[2]] + i), o_[2]);
    }
    return TestTriangle(d, Used(block, i), x, y, z, s_x_, s_y_, s_z_);
  }

  static HWY_INLINE hn::Mask<DLeaf> Used(const TriangleBlock& block, size_t i) {
    const hn::RebindToSigned<DLeaf> di;
    return hn::RebindMask(DLeaf(), hn::Gt(hn::Load(di, Prims(block) + i), hn::Set(di, kNoHit)));
  }
  static HWY_INLINE const int32_t* Prims(const TriangleBlock& block) {
    return reinterpret_cast<const int32_t*>(block.prim);
  }

 private:
  const TriangleBlock* blocks_;
  int axis_[3];
  VLeaf o_[3], s_x_, s_y_, s_z_;
};

// One ray against the spheres of a block: distances, +inf for misses and for unused lanes.
class SphereLeaf {
 public:
  HWY_INLINE SphereLeaf(const Plan& plan, const RayLanes& rays, size_t lane) : blocks_(plan.sphere_blocks.data()) {
    const DLeaf d;
    HWY_UNROLL(3)
    for (int k = 0; k < 3; ++k) {
      o_[k] = hn::Set(d, rays.o[k][lane]);
      dir_[k] = hn::Set(d, rays.d[k][lane]);
    }
    a_ = hn::MulAdd(dir_[0], dir_[0], hn::MulAdd(dir_[1], dir_[1], hn::Mul(dir_[2], dir_[2])));
    inv_a_ = hn::Div(hn::Set(d, 1.0f), a_);
  }

  HWY_INLINE const SphereBlock& Block(size_t block) const { return blocks_[block]; }

  HWY_INLINE VLeaf Test(const SphereBlock& block, size_t i) const {
    const DLeaf d;
    const hn::RebindToSigned<DLeaf> di;
    VLeaf f[3];
    HWY_UNROLL(3)
    for (int k = 0; k < 3; ++k) f[k] = hn::Sub(o_[k], hn::Load(d, block.center[k] + i));
    const VLeaf t = SphereRoot(d, f, dir_, a_, inv_a_, hn::Load(d, block.radius + i));
    const auto used = hn::RebindMask(d, hn::Gt(hn::Load(di, Prims(block) + i), hn::Set(di, kNoHit)));
    return hn::IfThenElse(used, t, hn::Set(d, kInfinity));
  }

  static HWY_INLINE const int32_t* Prims(const SphereBlock& block) {
    return reinterpret_cast<const int32_t*>(block.prim);
  }

 private:
  const SphereBlock* blocks_;
  VLeaf o_[3], dir_[3], a_, inv_a_;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
