#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/connect_camera.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/rng-inl.h"
#include "kernels/sampling-inl.h"
#include "kernels/shading-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

void ConnectCamera(const Plan& plan, const PathState& s, Range range) {
  const DF df;
  const DI di;
  const PlanCamera& camera = plan.camera;
  const Vec3 eye = SplatVec3(camera.eye), forward = SplatVec3(camera.forward);
  const Vec3 right = SplatVec3(camera.right), up = SplatVec3(camera.up);
  const Window window = plan.settings.window();
  const float width = static_cast<float>(plan.settings.width), height = static_cast<float>(plan.settings.height);
  const bool has_lens = camera.lens_radius > 0;
  const VF zero = hn::Zero(df), one = Splat(1.0f), per_pixel = Splat(1 / camera.pixel);
  const VF scale = Splat(plan.lamp_paths[s.step.light].scale * kInvPi / (camera.pixel * camera.pixel));
  const auto within = [&](VF x, uint32_t from, uint32_t size) HWY_ATTR {
    return hn::And(hn::Ge(x, Splat(static_cast<float>(from))), hn::Lt(x, Splat(static_cast<float>(from + size))));
  };
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(df)) {
    const Vec3 d = LoadVec3(s.d_x, s.d_y, s.d_z, i), p = LoadVec3(s.o_x, s.o_y, s.o_z, i);
    const Vec3 n = LoadVec3(s.n_x, s.n_y, s.n_z, i);
    Vec3 e = eye;
    VF lens_x = zero, lens_y = zero;
    if (has_lens) {
      const Random4 on_lens = DrawRandom(plan, s, i, kSetLens);
      const VF r = hn::Sqrt(on_lens.u[kDrawU]);
      VF sin, cos;
      SinCos2Pi(on_lens.u[kDrawV], sin, cos);
      lens_x = hn::Mul(r, cos), lens_y = hn::Mul(r, sin);
      const VF radius = Splat(camera.lens_radius);
      e = MulAdd(hn::Mul(radius, lens_x), right, MulAdd(hn::Mul(radius, lens_y), up, eye));
    }
    const Vec3 origin = OffsetOrigin(p, n, hn::Load(df, s.err + i), Sub(e, p));
    const Vec3 l = Sub(e, origin);
    const VF depth = hn::Neg(Dot(l, forward));
    const VF per_depth = hn::Div(one, hn::Max(depth, Splat(1e-30f)));
    // Where the ray from e through the point meets the picture at distance 1; with a lens, as `generate` shifts it.
    VF across = hn::Neg(hn::Mul(Dot(l, right), per_depth)), upwards = hn::Neg(hn::Mul(Dot(l, up), per_depth));
    if (has_lens) {
      across = hn::MulAdd(Splat(camera.lens_angle), lens_x, across);
      upwards = hn::MulAdd(Splat(camera.lens_angle), lens_y, upwards);
    }
    const VF x = hn::MulAdd(across, per_pixel, Splat(width / 2)),
             y = hn::NegMulAdd(upwards, per_pixel, Splat(height / 2));

    const VF towards = AbsDot(l, n);  // cosine * distance
    const VF shading = Dot(l, ViewerSide(LoadVec3(s.s_x, s.s_y, s.s_z, i), d));
    // cosine / (distance^2 cos^3) with cos = depth / distance
    const VF weight = hn::Mul(hn::Mul(scale, towards), hn::Mul(per_depth, hn::Mul(per_depth, per_depth)));
    MF seen = hn::And(hn::Gt(depth, zero), hn::Gt(shading, zero));
    seen = hn::And(seen, hn::And(within(x, window.x, window.width), within(y, window.y, window.height)));
    if (!plan.prim_normals.empty()) seen = hn::And(seen, Agrees(s, i, l));
    const Vec3 albedo =
        plan.textures.empty() ? LaneMaterials(plan, s, i).GetVec3(kReflectance) : LoadVec3(s.a_r, s.a_g, s.a_b, i);
    const Vec3 c = Scale(weight, Mul(albedo, LoadVec3(s.beta_r, s.beta_g, s.beta_b, i)));
    StoreVec3(IfThenElseZero(seen, c), s.c_r, s.c_g, s.c_b, i);
    StoreVec3(l, s.l_x, s.l_y, s.l_z, i);
    StoreVec3({zero, zero, zero}, s.L_r, s.L_g, s.L_b, i);
    const VI column = hn::ConvertTo(di, hn::IfThenElseZero(seen, x)),
             row = hn::ConvertTo(di, hn::IfThenElseZero(seen, y));
    const VI pixel = hn::Add(hn::Mul(row, hn::Set(di, static_cast<int32_t>(plan.settings.width))), column);
    hn::Store(hn::BitCast(DU(), pixel), DU(), s.raster + i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(ConnectCamera, connect_camera);
}  // namespace lanewise
#endif
