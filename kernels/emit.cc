#include <algorithm>

#include "core/plan_light_paths.h"
#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/emit.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/light_point-inl.h"
#include "kernels/rng-inl.h"
#include "kernels/sampling-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// The cone in which a caster's sphere is seen: 1 - cosine of its half angle, and its axis; all directions from inside, or near it.
struct Cone {
  Vec3 axis;
  VF height;
};

HWY_INLINE Cone SeenFrom(const Caster& caster, const Vec3& from) {
  const VF one = Splat(1.0f);
  const Vec3 to = Sub(SplatVec3(caster.center), from);
  const VF distance2 = hn::Max(Dot(to, to), Splat(1e-30f));
  const VF sine2 = hn::Div(Splat(caster.radius * caster.radius), distance2);
  const VF height = hn::Div(sine2, hn::Add(one, hn::Sqrt(hn::Max(hn::Sub(one, sine2), hn::Zero(DF())))));
  return {Scale(hn::Div(one, hn::Sqrt(distance2)), to),
          hn::IfThenElse(hn::Lt(sine2, Splat(kMostSine2)), height, Splat(2.0f))};
}

// A cone chosen by its solid angle.
struct ChosenCone {
  Cone cone;
  VF index;
  VF total;  // of all cones' heights

  HWY_INLINE ChosenCone(const Plan& plan, const Vec3& from, VF u) {
    const size_t n = plan.casters.size();
    total = hn::Zero(DF());
    for (size_t k = 0; k < n; ++k) total = hn::Add(total, SeenFrom(plan.casters[k], from).height);
    const VF at = hn::Mul(u, total);
    cone = SeenFrom(plan.casters[0], from);
    index = hn::Zero(DF());
    VF below = cone.height;
    for (size_t k = 1; k < n; ++k) {
      const Cone next = SeenFrom(plan.casters[k], from);
      const MF taken = hn::Ge(at, below);
      cone.axis = IfThenElse(taken, next.axis, cone.axis);
      cone.height = hn::IfThenElse(taken, next.height, cone.height);
      index = hn::IfThenElse(taken, Splat(static_cast<float>(k)), index);
      below = hn::Add(below, next.height);
    }
  }

  // In how many cones the direction lies: in the chosen one, whatever rounding says, and in others by chance.
  HWY_INLINE VF Cover(const Plan& plan, const Vec3& from, const Vec3& direction) const {
    VF cover = Splat(1.0f);
    for (size_t k = 0; k < plan.casters.size() && plan.casters.size() > 1; ++k) {
      const Cone other = SeenFrom(plan.casters[k], from);
      // 1 - cosine of the angle between them is half the square of their difference.
      const Vec3 apart = Sub(direction, other.axis);
      const MF inside =
          hn::Or(hn::Le(Dot(apart, apart), hn::Add(other.height, other.height)), hn::Eq(other.height, Splat(2.0f)));
      const MF chosen = hn::Eq(index, Splat(static_cast<float>(k)));
      cover = hn::Add(cover, hn::IfThenElseZero(hn::AndNot(chosen, inside), Splat(1.0f)));
    }
    return cover;
  }
};

void Emit(const Plan& plan, const PathState& s, Range range) {
  const DF d;
  const DU du;
  const PlanLight& light = plan.lights[s.step.light];
  const LampPaths& paths = plan.lamp_paths[s.step.light];
  const float brightest = std::max({light.radiance[0], light.radiance[1], light.radiance[2]});
  const Vec3 colour = Scale(Splat(1 / brightest), SplatVec3(light.radiance));
  const VF throughput = Splat(2 * kPi * paths.throughput), zero = hn::Zero(d), one = Splat(1.0f);
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    for (size_t k = 0; k < hn::Lanes(d); ++k) {
      const uint64_t number = s.batch.first_path + i + k;
      s.pixel[i + k] = light_path_pixel(number);
      s.sample[i + k] = light_path_sample(number);
      s.slot[i + k] = i + k < range.end ? static_cast<uint32_t>(i + k) : s.capacity;
    }
    const Random4 path = DrawRandom(plan, s, i, kSetPath), choice = DrawRandom(plan, s, i, kSetChoice);
    Random4 random;
    random.u[kDrawPatch] = choice.u[kDrawFirstPatch];
    random.u[kDrawSphere] = zero;
    random.u[kDrawLightU] = path.u[kDrawU];
    random.u[kDrawLightV] = path.u[kDrawV];
    const LightPoint at = SampleLightPoint(plan, light, random);
    const ChosenCone chosen(plan, at.q, choice.u[kDrawCaster]);

    const VF height = hn::Mul(path.u[kDrawEmitU], chosen.cone.height);  // 1 - cosine from the axis, uniform
    const VF sine = hn::Sqrt(hn::Max(hn::Mul(height, hn::Sub(Splat(2.0f), height)), zero));
    VF sin, cos;
    SinCos2Pi(path.u[kDrawEmitV], sin, cos);
    Vec3 b1, b2;
    Frame(chosen.cone.axis, b1, b2);
    const Vec3 local = {hn::Mul(sine, cos), hn::Mul(sine, sin), hn::Sub(one, height)};
    const Vec3 direction = ToWorld(local, b1, b2, chosen.cone.axis);
    const VF cosine = hn::Max(Dot(direction, at.n), zero);
    const VF angle = hn::Div(chosen.total, chosen.Cover(plan, at.q, direction));
    const VF scale = hn::Mul(hn::Mul(throughput, angle), cosine);
    StoreVec3(Scale(scale, colour), s.beta_r, s.beta_g, s.beta_b, i);
    StoreVec3(at.q, s.o_x, s.o_y, s.o_z, i);
    StoreVec3(direction, s.d_x, s.d_y, s.d_z, i);
    StoreVec3({zero, zero, zero}, s.L_r, s.L_g, s.L_b, i);
    hn::Store(zero, d, s.pdf + i);
    hn::Store(hn::Set(du, kByItself), du, s.lamps + i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(Emit, emit);
}  // namespace lanewise
#endif
