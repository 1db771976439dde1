// Vectors of lanes: what every kernel starts from. Width-agnostic: 1 lane (scalar) to 16 (AVX-512), never more than
// kLanes. Include after hwy/highway.h, inside the per-target pass.
#if defined(LANEWISE_KERNELS_SIMD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_SIMD_INL_H_
#undef LANEWISE_KERNELS_SIMD_INL_H_
#else
#define LANEWISE_KERNELS_SIMD_INL_H_
#endif

#include "core/path_state.h"
#include "core/types.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::CappedTag<float, kLanes>;
using DU = hn::RebindToUnsigned<DF>;
using DI = hn::RebindToSigned<DF>;
using VF = hn::Vec<DF>;
using VU = hn::Vec<DU>;
using VI = hn::Vec<DI>;
using MF = hn::Mask<DF>;

HWY_INLINE VF Splat(float x) { return hn::Set(DF(), x); }

struct Vec3 {
  VF x, y, z;
};

HWY_INLINE Vec3 LoadVec3(const float* x, const float* y, const float* z, size_t i) {
  return {hn::Load(DF(), x + i), hn::Load(DF(), y + i), hn::Load(DF(), z + i)};
}
HWY_INLINE void StoreVec3(const Vec3& a, float* x, float* y, float* z, size_t i) {
  hn::Store(a.x, DF(), x + i);
  hn::Store(a.y, DF(), y + i);
  hn::Store(a.z, DF(), z + i);
}
HWY_INLINE Vec3 SplatVec3(const float* a) { return {Splat(a[0]), Splat(a[1]), Splat(a[2])}; }

// Consecutive members of records of floats: base[index] .. base[index + 2].
HWY_INLINE Vec3 GatherVec3(const float* base, VI index) {
  return {hn::GatherIndex(DF(), base, index), hn::GatherIndex(DF(), base + 1, index),
          hn::GatherIndex(DF(), base + 2, index)};
}

// At places of three arrays.
HWY_INLINE Vec3 GatherVec3(const float* x, const float* y, const float* z, VI index) {
  return {hn::GatherIndex(DF(), x, index), hn::GatherIndex(DF(), y, index), hn::GatherIndex(DF(), z, index)};
}
HWY_INLINE void ScatterVec3(const Vec3& a, float* x, float* y, float* z, VI index) {
  hn::ScatterIndex(a.x, DF(), x, index);
  hn::ScatterIndex(a.y, DF(), y, index);
  hn::ScatterIndex(a.z, DF(), z, index);
}

HWY_INLINE Vec3 Add(const Vec3& a, const Vec3& b) { return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)}; }
HWY_INLINE Vec3 Sub(const Vec3& a, const Vec3& b) { return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)}; }
HWY_INLINE Vec3 Mul(const Vec3& a, const Vec3& b) { return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)}; }
HWY_INLINE Vec3 Scale(VF s, const Vec3& a) { return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)}; }
HWY_INLINE Vec3 Neg(const Vec3& a) { return {hn::Neg(a.x), hn::Neg(a.y), hn::Neg(a.z)}; }
// s a + b
HWY_INLINE Vec3 MulAdd(VF s, const Vec3& a, const Vec3& b) {
  return {hn::MulAdd(s, a.x, b.x), hn::MulAdd(s, a.y, b.y), hn::MulAdd(s, a.z, b.z)};
}
HWY_INLINE Vec3 IfThenElse(MF m, const Vec3& a, const Vec3& b) {
  return {hn::IfThenElse(m, a.x, b.x), hn::IfThenElse(m, a.y, b.y), hn::IfThenElse(m, a.z, b.z)};
}
HWY_INLINE Vec3 IfThenElseZero(MF m, const Vec3& a) {
  return {hn::IfThenElseZero(m, a.x), hn::IfThenElseZero(m, a.y), hn::IfThenElseZero(m, a.z)};
}
HWY_INLINE VF Dot(const Vec3& a, const Vec3& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
HWY_INLINE VF AbsDot(const Vec3& a, const Vec3& b) { return hn::Abs(Dot(a, b)); }
HWY_INLINE VF MaxElement(const Vec3& a) { return hn::Max(a.x, hn::Max(a.y, a.z)); }

HWY_INLINE Vec3 Cross(const Vec3& a, const Vec3& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

// a / |a| by true square root and division, the same on every machine; a must not be zero.
HWY_INLINE Vec3 Normalize(const Vec3& a) { return Scale(hn::Div(Splat(1.0f), hn::Sqrt(Dot(a, a))), a); }

// Two unit vectors that complete the unit vector n to a right-handed frame (Duff et al., JCGT 6(1), 2017).
HWY_INLINE void Frame(const Vec3& n, Vec3& b1, Vec3& b2) {
  const VF one = Splat(1.0f);
  const VF sign = hn::CopySign(one, n.z);
  const VF a = hn::Div(Splat(-1.0f), hn::Add(sign, n.z));
  const VF b = hn::Mul(hn::Mul(n.x, n.y), a);
  b1 = {hn::MulAdd(hn::Mul(sign, hn::Mul(n.x, n.x)), a, one), hn::Mul(sign, b), hn::Neg(hn::Mul(sign, n.x))};
  b2 = {b, hn::MulAdd(hn::Mul(n.y, n.y), a, sign), hn::Neg(n.y)};
}

// A vector given in the frame (b1, b2, n), in the world's.
HWY_INLINE Vec3 ToWorld(const Vec3& local, const Vec3& b1, const Vec3& b2, const Vec3& n) {
  return MulAdd(local.x, b1, MulAdd(local.y, b2, Scale(local.z, n)));
}

// A ray origin safely off the surface at p with unit normal n, on the side that dir leaves to; err as `surface` made
// it.
HWY_INLINE Vec3 OffsetOrigin(const Vec3& p, const Vec3& n, VF err, const Vec3& dir) {
  return MulAdd(hn::CopySign(err, Dot(dir, n)), n, p);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
