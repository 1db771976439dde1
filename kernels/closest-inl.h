// The closest hit of a vector of rays in all of a plan's primitives: flat lists with all lanes at once, then the trees,
// many rays in flight, for those that meet their bounds. A ray's result does not depend on the vector's width, nor on whether a
// primitive is in a list or a tree.
#if defined(LANEWISE_KERNELS_CLOSEST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_CLOSEST_INL_H_
#undef LANEWISE_KERNELS_CLOSEST_INL_H_
#else
#define LANEWISE_KERNELS_CLOSEST_INL_H_
#endif

#include "core/plan.h"
#include "kernels/flat-inl.h"
#include "kernels/flight-inl.h"
#include "kernels/leaf-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// Where the hits of rays go. t is how far a ray goes, and prim what it has met there.
struct HitArrays {
  float *t, *u, *v;
  uint32_t* prim;

  // Whether the hit is nearer than what the ray has met, or as near with a lower index, and now in its place.
  HWY_INLINE bool Take(uint32_t ray, float hit_t, uint32_t hit_prim) const {
    const bool lower = static_cast<int32_t>(hit_prim) < static_cast<int32_t>(prim[ray]);
    if (!(hit_t < t[ray] || (hit_t == t[ray] && lower))) return false;
    t[ray] = hit_t;
    prim[ray] = hit_prim;
    return true;
  }
};

// What a Flight looks for: the nearest triangle.
class NearestTriangle : public TriangleLeaves {
 public:
  static constexpr bool kNearest = true;

  NearestTriangle(const Plan& plan, const HitArrays& hits) : TriangleLeaves(plan), hits_(hits) {}

  HWY_INLINE bool Visit(const Ray& ray, const Block& block, uint32_t hits, Test& test, NodeRay& node_ray) const {
    const uint32_t index = node_ray.index;
    bool nearer = false;
    for (hits = MakeSure(block, ray, hits, test); hits != 0; hits &= hits - 1) {
      const size_t k = static_cast<size_t>(std::countr_zero(hits));
      const float t = test.depth[k] / test.det[k];
      if (!(t > 0) || !hits_.Take(index, t, block.prim[k])) continue;
      hits_.u[index] = test.v[k] / test.det[k];
      hits_.v[index] = test.w[k] / test.det[k];
      node_ray.t_max = t;
      nearer = true;
    }
    return nearer;
  }

 private:
  HitArrays hits_;
};

// The nearest sphere.
class NearestSphere : public SphereLeaves {
 public:
  static constexpr bool kNearest = true;

  NearestSphere(const Plan& plan, const HitArrays& hits) : SphereLeaves(plan), hits_(hits) {}

  HWY_INLINE bool Visit(const Ray& /*ray*/, const Block& block, uint32_t hits, const Test& test,
                        NodeRay& node_ray) const {
    const uint32_t index = node_ray.index;
    bool nearer = false;
    for (; hits != 0; hits &= hits - 1) {
      const size_t k = static_cast<size_t>(std::countr_zero(hits));
      if (!hits_.Take(index, test.t[k], block.prim[k])) continue;
      hits_.u[index] = hits_.v[index] = 0;
      node_ray.t_max = test.t[k];
      nearer = true;
    }
    return nearer;
  }

 private:
  HitArrays hits_;
};

constexpr size_t kClosestBatch = 1024;
using ClosestList = RayList<kClosestBatch>;

inline HWY_NOINLINE void WalkNearestTriangle(const Plan& plan, const ClosestList& rays, const HitArrays& hits) {
  Flight<NearestTriangle>(plan.triangle_tree, NearestTriangle(plan, hits)).Walk(rays);
}
inline HWY_NOINLINE void WalkNearestSphere(const Plan& plan, const ClosestList& rays, const HitArrays& hits) {
  Flight<NearestSphere>(plan.sphere_tree, NearestSphere(plan, hits)).Walk(rays);
}

// Closest hits of rays begin .. end - 1, whole vectors of them: t = +inf, prim = kNoPrim and u = v = 0 for none.
// ray(i, o, d) gives the vector of rays at i and returns which of its lanes are rays at all; the others hit nothing.
template <class RayAt>
HWY_INLINE void ClosestHits(const Plan& plan, const HitArrays& hits, size_t begin, size_t end, RayAt ray) {
  const DF d;
  const VF zero = hn::Zero(d);
  ClosestList triangle_rays, sphere_rays;
  for (size_t batch = begin; batch < end; batch += kClosestBatch) {
    for (size_t i = batch; i < std::min(end, batch + kClosestBatch); i += hn::Lanes(d)) {
      Vec3 o, dir;
      const MF alive = ray(i, o, dir);
      // A dead lane's limit of 0 lets no hit pass.
      Nearest best{hn::IfThenElseZero(alive, Splat(kInfinity)), zero, zero, Splat(1.0f), hn::Set(DI(), kNoHit)};
      NearestFlatQuad(plan, o, dir, best);
      NearestFlatSlab(plan, o, dir, best);
      NearestFlatSphere(plan, o, dir, best);
      NearestFlatTriangle(plan, o, dir, alive, best);
      triangle_rays.Add(plan.triangle_tree, i, o, dir, best.t, alive);
      sphere_rays.Add(plan.sphere_tree, i, o, dir, best.t, alive);
      const MF none = hn::RebindMask(d, hn::Eq(best.prim, hn::Set(DI(), kNoHit)));
      hn::Store(hn::IfThenElse(none, Splat(kInfinity), best.t), d, hits.t + i);
      const bool weighed = !plan.flat_triangles.empty();
      hn::Store(weighed ? hn::Div(best.v, best.det) : zero, d, hits.u + i);
      hn::Store(weighed ? hn::Div(best.w, best.det) : zero, d, hits.v + i);
      hn::Store(hn::BitCast(DU(), best.prim), DU(), hits.prim + i);
    }
    if (triangle_rays.size() > 0) WalkNearestTriangle(plan, triangle_rays, hits);
    if (sphere_rays.size() > 0) WalkNearestSphere(plan, sphere_rays, hits);
    triangle_rays.clear();
    sphere_rays.clear();
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
