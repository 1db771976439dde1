#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/generate.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/math-inl.h"
#include "kernels/rng-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// Which pixel and sample each slot holds, and the pixel's column and row, left in o for the vector loop.
void Assign(const Plan& plan, const PathState& s, Range range) {
  const Batch& batch = s.batch;
  const uint64_t first = batch.first_path + range.begin;
  const uint32_t group = batch.group;
  for (uint32_t member = 0; member < group; ++member) {
    uint64_t pixel_index = first / group / batch.samples * group + member;
    uint32_t sample = static_cast<uint32_t>(first / group % batch.samples);
    for (uint32_t i = range.begin + member; i < range.end; pixel_index += group, sample = 0) {
      const uint32_t pixel = batch.pixels[pixel_index];
      const float x = static_cast<float>(pixel % plan.settings.width);
      const float y = static_cast<float>(pixel / plan.settings.width);
      for (; sample < batch.samples && i < range.end; ++sample, i += group) {
        s.pixel[i] = pixel;
        s.sample[i] = static_cast<uint32_t>(batch.first_sample + sample);
        s.slot[i] = pixel == kNoPixel ? s.capacity : i;
        s.o_x[i] = x;
        s.o_y[i] = y;
      }
    }
  }
  // The last vector's other lanes make camera rays too, but as padding: the first sort drops them.
  for (uint32_t i = range.end; i < round_up_to_lanes(range.end); ++i) s.slot[i] = s.capacity;
}

void Generate(const Plan& plan, const PathState& s, Range range) {
  Assign(plan, s, range);
  const PlanCamera& camera = plan.camera;
  const VF half_width = Splat(0.5f * static_cast<float>(plan.settings.width));
  const VF half_height = Splat(0.5f * static_cast<float>(plan.settings.height));
  const VF pixel = Splat(camera.pixel);
  const Vec3 eye = SplatVec3(camera.eye), forward = SplatVec3(camera.forward);
  const Vec3 right = SplatVec3(camera.right), up = SplatVec3(camera.up);
  const bool has_lens = camera.lens_radius > 0;
  const VF lens_radius = Splat(camera.lens_radius), lens_angle = Splat(camera.lens_angle);
  const VF zero = hn::Zero(DF()), one = Splat(1.0f);
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(DF())) {
    const Random4 random = DrawRandom(plan, s, i, kSetPath);
    const VF x = hn::Sub(hn::Add(hn::Load(DF(), s.o_x + i), random.u[kDrawU]), half_width);
    const VF y = hn::Sub(half_height, hn::Add(hn::Load(DF(), s.o_y + i), random.u[kDrawV]));
    VF across = hn::Mul(x, pixel), upwards = hn::Mul(y, pixel);
    Vec3 o = eye;
    if (has_lens) {
      const Random4 on_lens = DrawRandom(plan, s, i, kSetLens);
      const VF r = hn::Sqrt(on_lens.u[kDrawU]);
      VF sin, cos;
      SinCos2Pi(on_lens.u[kDrawV], sin, cos);
      const VF lens_x = hn::Mul(r, cos), lens_y = hn::Mul(r, sin);
      o = MulAdd(hn::Mul(lens_radius, lens_x), right, MulAdd(hn::Mul(lens_radius, lens_y), up, eye));
      // All rays of this x and y meet at the focal distance.
      across = hn::NegMulAdd(lens_angle, lens_x, across);
      upwards = hn::NegMulAdd(lens_angle, lens_y, upwards);
    }
    const Vec3 d = Normalize(MulAdd(across, right, MulAdd(upwards, up, forward)));
    StoreVec3(o, s.o_x, s.o_y, s.o_z, i);
    StoreVec3(d, s.d_x, s.d_y, s.d_z, i);
    StoreVec3({one, one, one}, s.beta_r, s.beta_g, s.beta_b, i);
    StoreVec3({zero, zero, zero}, s.L_r, s.L_g, s.L_b, i);
    hn::Store(zero, DF(), s.pdf + i);
    hn::Store(hn::Set(DU(), kByItself), DU(), s.lamps + i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(Generate, generate);
}  // namespace lanewise
#endif
