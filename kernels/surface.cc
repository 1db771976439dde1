#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/surface.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/records-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// Below this squared length corner normals have cancelled, and their mean says nothing.
constexpr float kLeastNormal2 = 1e-12f;

// Corner normals mixed by barycentric weights; the face's own normal n where they cancel. normals: nine floats a lane.
HWY_INLINE Vec3 ShadingNormal(const LaneRecords& normals, VF u, VF v, const Vec3& n) {
  Vec3 first, second, third;
  normals.Get4(0, first.x, first.y, first.z, second.x);
  normals.Get4(4, second.y, second.z, third.x, third.y);
  third.z = normals.Get(8);
  const VF w = hn::Sub(hn::Sub(Splat(1.0f), u), v);
  const Vec3 mixed = MulAdd(u, second, MulAdd(v, third, Scale(w, first)));
  const VF length2 = Dot(mixed, mixed);
  const MF usable = hn::Gt(length2, Splat(kLeastNormal2));
  return IfThenElse(usable, Scale(hn::Div(Splat(1.0f), hn::Sqrt(length2)), mixed), n);
}

void Surface(const Plan& plan, const PathState& s, Range range) {
  const DF d;
  const DI di;
  const int32_t last_triangle = static_cast<int32_t>(plan.triangles) - 1;
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const VI prim = hn::BitCast(di, hn::Load(DU(), s.prim + i));
    Vec3 shape;
    VF size;
    LaneRecords(plan.prim_shape.data(), 4, s.prim + i).Get4(0, shape.x, shape.y, shape.z, size);
    const Vec3 dir = LoadVec3(s.d_x, s.d_y, s.d_z, i);
    const Vec3 hit = MulAdd(hn::Load(d, s.t + i), dir, LoadVec3(s.o_x, s.o_y, s.o_z, i));

    // The distance's error is along the ray; what is left across the surface is taken back along the normal.
    Vec3 n = shape, p = MulAdd(hn::Sub(size, Dot(shape, hit)), shape, hit);
    VI triangle = prim;
    const auto beyond = hn::Gt(prim, hn::Set(di, last_triangle));
    const MF is_sphere = hn::RebindMask(d, beyond);
    if (!hn::AllFalse(di, beyond)) {  // a vector of one bin seldom has both
      const Vec3 out = Sub(hit, shape);
      const VF length2 = Dot(out, out);
      // Of a hit that rounding puts into the very center any normal is right.
      const Vec3 unit =
          IfThenElse(hn::Gt(length2, hn::Zero(d)), Scale(hn::Div(Splat(1.0f), hn::Sqrt(length2)), out), Neg(dir));
      n = IfThenElse(is_sphere, unit, n);
      p = IfThenElse(is_sphere, MulAdd(size, unit, shape), p);
      triangle = hn::IfThenZeroElse(beyond, prim);
    }
    Vec3 shading = n;
    if (!plan.prim_normals.empty()) {
      const VF u = hn::Load(d, s.u + i), v = hn::Load(d, s.v + i);
      HWY_ALIGN uint32_t triangles[hn::MaxLanes(d)];
      hn::Store(hn::BitCast(DU(), triangle), DU(), triangles);
      const LaneRecords normals(plan.prim_normals.data(), 9, triangles);
      shading = IfThenElse(is_sphere, n, ShadingNormal(normals, u, v, n));
    }
    StoreVec3(p, s.o_x, s.o_y, s.o_z, i);
    StoreVec3(n, s.n_x, s.n_y, s.n_z, i);
    StoreVec3(shading, s.s_x, s.s_y, s.s_z, i);
    hn::Store(LaneRecords(plan.prim_err.data(), 1, s.prim + i).Get(0), d, s.err + i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(Surface, surface);
}  // namespace lanewise
#endif
