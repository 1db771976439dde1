#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/occlude.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/flat-inl.h"
#include "kernels/flight-inl.h"
#include "kernels/leaf-inl.h"
#include "kernels/shadow-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// What a Flight looks for: any triangle within the segment; blocked[ray] = 1 if there is one.
class AnyTriangle : public TriangleLeaves {
 public:
  static constexpr bool kNearest = false;

  AnyTriangle(const Plan& plan, float* blocked) : TriangleLeaves(plan), blocked_(blocked) {}

  HWY_INLINE bool Visit(const Ray& ray, const Block& block, uint32_t hits, Test& test, const NodeRay& node_ray) const {
    const DLeaf d;
    const uint32_t met = MakeSure(block, ray, hits, test);
    uint32_t within = 0;
    for (size_t i = 0; i < kLeafWidth; i += hn::Lanes(d)) {
      within |= MaskBits(d, WithinSegment(d, hn::Load(d, test.depth + i), hn::Load(d, test.det + i))) << i;
    }
    if ((met & within) == 0) return false;
    blocked_[node_ray.index] = 1;
    return true;
  }

 private:
  float* blocked_;
};

// Any sphere within the segment.
class AnySphere : public SphereLeaves {
 public:
  static constexpr bool kNearest = false;

  AnySphere(const Plan& plan, float* blocked) : SphereLeaves(plan), blocked_(blocked) {}

  HWY_INLINE bool Visit(const Ray& /*ray*/, const Block& /*block*/, uint32_t /*hits*/, const Test& test,
                        const NodeRay& node_ray) const {
    for (const float root : test.t) {
      if (root < 1) return blocked_[node_ray.index] = 1, true;
    }
    return false;
  }

 private:
  float* blocked_;
};

// The segments of a shadow ray: to the light; or of a connection to the sphere, and from there to the light.
template <int kSegments>
HWY_INLINE void Segment(const PathState& s, size_t i, int segment, Vec3& o, Vec3& dir) {
  const Vec3 l = LoadVec3(s.l_x, s.l_y, s.l_z, i);
  o = ShadowOrigin(s, i, l);
  dir = l;
  if (kSegments == 1 || segment == 0) return;
  o = Add(o, l);
  dir = LoadVec3(s.m_x, s.m_y, s.m_z, i);
}

// What the spheres of connections reflect of each channel.
HWY_INLINE Vec3 ViaReflectance(const Plan& plan, const PathState& s, size_t i) {
  const VU via = hn::Load(DU(), s.via + i);
  Vec3 reflectance = SplatVec3(plan.connected_spheres[0].reflectance);
  for (uint32_t k = 1; k < plan.connected_spheres.size(); ++k) {
    const MF by = hn::RebindMask(DF(), hn::Eq(via, hn::Set(DU(), k)));
    reflectance = IfThenElse(by, SplatVec3(plan.connected_spheres[k].reflectance), reflectance);
  }
  return reflectance;
}

HWY_INLINE void AddLight(const PathState& s, size_t i, MF lit, const Vec3& c) {
  StoreVec3(Add(LoadVec3(s.L_r, s.L_g, s.L_b, i), IfThenElseZero(lit, c)), s.L_r, s.L_g, s.L_b, i);
}

template <int kSegments>
void OccludeFlat(const Plan& plan, const PathState& s, Range range) {
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(DF())) {
    const Vec3 c = LoadVec3(s.c_r, s.c_g, s.c_b, i);
    MF open = IsWanted(c);
    for (int segment = 0; segment < kSegments && !hn::AllFalse(DF(), open); ++segment) {
      Vec3 o, dir;
      Segment<kSegments>(s, i, segment, o, dir);
      open = hn::AndNot(AnyFlatHit(plan, o, dir, open), open);
    }
    AddLight(s, i, open, kSegments == 1 ? c : Mul(c, ViaReflectance(plan, s, i)));
  }
}

constexpr size_t kShadowBatch = 1024;
using ShadowList = RayList<kShadowBatch>;

HWY_NOINLINE void WalkAnyTriangle(const Plan& plan, const ShadowList& rays, float* blocked) {
  Flight<AnyTriangle>(plan.triangle_tree, AnyTriangle(plan, blocked)).Walk(rays);
}
HWY_NOINLINE void WalkAnySphere(const Plan& plan, const ShadowList& rays, float* blocked) {
  Flight<AnySphere>(plan.sphere_tree, AnySphere(plan, blocked)).Walk(rays);
}

template <int kSegments>
void OccludeTrees(const Plan& plan, const PathState& s, Range range) {
  const DF d;
  const VF one = Splat(1.0f);
  ShadowList triangle_rays, sphere_rays;
  HWY_ALIGN float blocked[kShadowBatch];
  for (size_t begin = range.begin; begin < range.end; begin += kShadowBatch) {
    const size_t end = std::min<size_t>(range.end, begin + kShadowBatch);
    for (int segment = 0; segment < kSegments; ++segment) {
      for (size_t i = begin; i < end; i += hn::Lanes(d)) {
        Vec3 o, dir;
        Segment<kSegments>(s, i, segment, o, dir);
        MF wanted = IsWanted(LoadVec3(s.c_r, s.c_g, s.c_b, i));
        if (segment > 0) wanted = hn::And(wanted, hn::Eq(hn::Load(d, blocked + (i - begin)), hn::Zero(d)));
        const MF open = hn::AndNot(AnyFlatHit(plan, o, dir, wanted), wanted);
        hn::Store(hn::IfThenZeroElse(open, one), d, blocked + (i - begin));
        triangle_rays.Add(plan.triangle_tree, i - begin, o, dir, one, open);
        sphere_rays.Add(plan.sphere_tree, i - begin, o, dir, one, open);
      }
      if (triangle_rays.size() > 0) WalkAnyTriangle(plan, triangle_rays, blocked);
      if (sphere_rays.size() > 0) WalkAnySphere(plan, sphere_rays, blocked);
      triangle_rays.clear();
      sphere_rays.clear();
    }
    for (size_t i = begin; i < end; i += hn::Lanes(d)) {
      const MF lit = hn::Eq(hn::Load(d, blocked + (i - begin)), hn::Zero(d));
      const Vec3 c = LoadVec3(s.c_r, s.c_g, s.c_b, i);
      AddLight(s, i, lit, kSegments == 1 ? c : Mul(c, ViaReflectance(plan, s, i)));
    }
  }
}

template <int kSegments>
void OccludeSegments(const Plan& plan, const PathState& s, Range range) {
  const bool flat = plan.triangle_tree.nodes.empty() && plan.sphere_tree.nodes.empty();
  (flat ? OccludeFlat<kSegments> : OccludeTrees<kSegments>)(plan, s, range);
}

void Occlude(const Plan& plan, const PathState& s, Range range) { OccludeSegments<1>(plan, s, range); }
void OccludeConnection(const Plan& plan, const PathState& s, Range range) { OccludeSegments<2>(plan, s, range); }

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(Occlude, occlude);
LANEWISE_KERNEL(OccludeConnection, occlude_connection);
}  // namespace lanewise
#endif
