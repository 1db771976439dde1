#include <algorithm>
#include <cstddef>
#include <new>

#include "core/plan_connections.h"
#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/connect_sphere.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/fresnel-inl.h"
#include "kernels/light_point-inl.h"
#include "kernels/reflection-inl.h"
#include "kernels/rng-inl.h"
#include "kernels/shading-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// One of the plan's connected spheres for each lane, and the chance of this choice as a fraction.
struct ChosenSphere {
  Vec3 center;
  VF radius, inv_radius, err;
  VF ior;  // 0: a mirror
  VF via;  // the sphere's index
  VF weight, total;

  HWY_INLINE ChosenSphere(const Plan& plan, const Vec3& x, VF u) {
    const size_t n = plan.connected_spheres.size();
    // importance / (distance / radius)^2 of each, times what all are divided by.
    VF distance2[kMaxConnectedSpheres], weights[kMaxConnectedSpheres];
    for (size_t k = 0; k < n; ++k) {
      const ConnectedSphere& sphere = plan.connected_spheres[k];
      const Vec3 to = Scale(Splat(1 / sphere.radius), Sub(x, SplatVec3(sphere.center)));
      distance2[k] = hn::Max(Dot(to, to), Splat(1.0f));
    }
    total = hn::Zero(DF());
    for (size_t k = 0; k < n; ++k) {
      weights[k] = Splat(plan.connected_spheres[k].importance);
      for (size_t j = 0; j < n; ++j) {
        if (j != k) weights[k] = hn::Mul(weights[k], distance2[j]);
      }
      total = hn::Add(total, weights[k]);
    }
    const VF at = hn::Mul(u, total);
    VF below = hn::Zero(DF());
    for (size_t k = 0; k < n; ++k) {
      Take(plan.connected_spheres[k], k, weights[k], hn::Ge(at, below));
      below = hn::Add(below, weights[k]);
    }
  }

 private:
  HWY_INLINE void Take(const ConnectedSphere& sphere, size_t index, VF its_weight, MF taken) {
    const auto take = [&](VF& to, VF value) HWY_ATTR { to = index == 0 ? value : hn::IfThenElse(taken, value, to); };
    take(center.x, Splat(sphere.center[0])), take(center.y, Splat(sphere.center[1]));
    take(center.z, Splat(sphere.center[2]));
    take(radius, Splat(sphere.radius)), take(inv_radius, Splat(1 / sphere.radius)), take(err, Splat(sphere.err));
    take(ior, Splat(sphere.ior)), take(via, Splat(static_cast<float>(index))), take(weight, its_weight);
  }
};

// A connection on its way from the hit point to the sphere and the light.
struct Aim {
  LightPoint at;
  ChosenSphere sphere;
  Bisector between;

  HWY_INLINE Aim(const Plan& plan, const PlanLight& light, const Random4& random, const Vec3& p)
      : at(SampleLightPoint(plan, light, random)),
        sphere(plan, p, random.u[kDrawSphere]),
        between(Sub(p, sphere.center), Sub(at.q, sphere.center), sphere.radius) {}
};

HWY_INLINE VF Reflectance(const Plan& plan, VF ior, const SphereReflection& reflection) {
  const VF one = Splat(1.0f);
  const MF mirror = hn::Eq(ior, hn::Zero(DF()));
  if (hn::AllTrue(DF(), mirror)) return one;
  const VF cosine = hn::Min(hn::Div(reflection.height, reflection.whole), one);
  const VF of_glass = FresnelDielectric(plan.settings.fresnel, cosine, one, ior).reflectance;
  return hn::IfThenElse(mirror, one, of_glass);
}

// Not so: light paths bring what these get by way of a sphere.
HWY_INLINE MF ByItself(const PathState& s, size_t i) {
  return hn::RebindMask(DF(), hn::Eq(hn::Load(DU(), s.lamps + i), hn::Set(DU(), kByItself)));
}

// No connection.
HWY_INLINE void Leave(const PathState& s, size_t i) {
  const VF zero = hn::Zero(DF());
  StoreVec3({zero, zero, zero}, s.l_x, s.l_y, s.l_z, i);
  StoreVec3({zero, zero, zero}, s.m_x, s.m_y, s.m_z, i);
  hn::Store(zero, DF(), s.l_pdf + i);
  hn::Store(hn::Zero(DU()), DU(), s.via + i);
}

// Where on the sphere, and with what density.
HWY_INLINE void Finish(const Plan& plan, const PathState& s, size_t i, const Aim& aim, VF tilt, VF light_area) {
  const DF d;
  const ChosenSphere& sphere = aim.sphere;
  const Vec3 p = LoadVec3(s.o_x, s.o_y, s.o_z, i);
  const SphereReflection reflection = ReflectInSphere(aim.between, tilt, Sub(p, sphere.center),
                                                      Sub(aim.at.q, sphere.center), sphere.radius, sphere.inv_radius);
  const Vec3 met = MulAdd(hn::Add(sphere.radius, sphere.err), reflection.n, sphere.center);
  const Vec3 n = LoadVec3(s.n_x, s.n_y, s.n_z, i);
  const Vec3 origin = OffsetOrigin(p, n, hn::Load(d, s.err + i), Sub(met, p));

  // The spread on the light's own area, over that; by one division.
  const VF facing =
      hn::Mul(hn::Mul(light_area, Reflectance(plan, sphere.ior, reflection)), hn::Neg(Dot(reflection.to_y, aim.at.n)));
  const VF top = hn::Mul(hn::Mul(sphere.weight, reflection.spread), reflection.distance);
  const VF pdf = hn::Div(top, hn::Mul(hn::Mul(sphere.total, reflection.height), facing));
  const Vec3 l = Sub(met, origin);
  MF wanted = ByItself(s, i);
  if (has_light_paths(plan) && !plan.prim_normals.empty()) wanted = hn::Or(wanted, hn::Not(Agrees(s, i, l)));
  const MF usable = hn::And(wanted, hn::And(reflection.exists, hn::Gt(facing, hn::Zero(d))));
  StoreVec3(IfThenElseZero(usable, l), s.l_x, s.l_y, s.l_z, i);
  StoreVec3(IfThenElseZero(usable, Sub(aim.at.q, met)), s.m_x, s.m_y, s.m_z, i);
  hn::Store(hn::IfThenElseZero(usable, pdf), d, s.l_pdf + i);
  hn::Store(hn::BitCast(DU(), hn::ConvertTo(DI(), hn::IfThenElseZero(usable, sphere.via))), DU(), s.via + i);
}

// In three loops over some vectors each: in one, a vector's divisions and square roots wait for each other, and what the
// processor can look ahead is too little to overlap the next vector's with them.
void ConnectSphere(const Plan& plan, const PathState& s, Range range) {
  constexpr size_t kVectors = 8;
  const size_t lanes = hn::Lanes(DF());
  const PlanLight& light = plan.lights[s.step.light];
  const uint32_t set = connection_set(plan, s.step);
  alignas(64) std::byte room[kVectors * sizeof(Aim)];
  Aim* aims = reinterpret_cast<Aim*>(room);
  VF tilt[kVectors];
  for (size_t i = range.begin; i < range.end;) {
    size_t at[kVectors];
    size_t n = 0;
    for (; i < range.end && n < kVectors; i += lanes) {
      if (plan.prim_normals.empty() && hn::AllFalse(DF(), ByItself(s, i))) {
        Leave(s, i);
      } else {
        at[n++] = i;
      }
    }
    for (size_t k = 0; k < n; ++k) {
      new (&aims[k]) Aim(plan, light, DrawRandom(plan, s, at[k], set), LoadVec3(s.o_x, s.o_y, s.o_z, at[k]));
    }
    for (size_t k = 0; k < n; ++k) tilt[k] = HalfTilt(aims[k].between);
    for (size_t k = 0; k < n; ++k) Finish(plan, s, at[k], aims[k], tilt[k], Splat(light.area));
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(ConnectSphere, connect_sphere);
}  // namespace lanewise
#endif
