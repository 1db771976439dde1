// Counter-based random numbers: a pure function of (seed, pixel, sample, set). The hash is pcg4d of Jarzynski & Olano,
// Hash Functions for GPU Rendering, JCGT 9(3), 2020. Scalar twin: kernels/reference/rng.h.
#if defined(LANEWISE_KERNELS_RNG_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_RNG_INL_H_
#undef LANEWISE_KERNELS_RNG_INL_H_
#else
#define LANEWISE_KERNELS_RNG_INL_H_
#endif

#include "core/dimensions.h"
#include "core/plan.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// Four independent uniforms in [0, 1), multiples of 2^-24.
struct Random4 {
  VF u[4];
};

HWY_INLINE VF ToUniform(VU bits) {
  return hn::Mul(hn::ConvertTo(DF(), hn::BitCast(DI(), hn::ShiftRight<8>(bits))), Splat(0x1p-24f));
}

HWY_INLINE Random4 DrawRandom(VU pixel, VU sample, uint32_t set, uint64_t seed) {
  const DU d;
  const VU a = hn::Set(d, 1664525u), c = hn::Set(d, 1013904223u);
  const auto step = [&](VU v) HWY_ATTR { return hn::Add(hn::Mul(v, a), c); };
  VU x = step(pixel), y = step(sample);
  VU z = hn::Set(d, (set ^ static_cast<uint32_t>(seed >> 32)) * 1664525u + 1013904223u);
  VU w = hn::Set(d, static_cast<uint32_t>(seed) * 1664525u + 1013904223u);
  const auto mix = [&]() HWY_ATTR {
    x = hn::Add(x, hn::Mul(y, w));
    y = hn::Add(y, hn::Mul(z, x));
    z = hn::Add(z, hn::Mul(x, y));
    w = hn::Add(w, hn::Mul(y, z));
  };
  mix();
  x = hn::Xor(x, hn::ShiftRight<16>(x));
  y = hn::Xor(y, hn::ShiftRight<16>(y));
  z = hn::Xor(z, hn::ShiftRight<16>(z));
  w = hn::Xor(w, hn::ShiftRight<16>(w));
  mix();
  return {{ToUniform(x), ToUniform(y), ToUniform(z), ToUniform(w)}};
}

// The set of the paths at slot i.
HWY_INLINE Random4 DrawRandom(const Plan& plan, const PathState& s, size_t i, uint32_t purpose) {
  return DrawRandom(hn::Load(DU(), s.pixel + i), hn::Load(DU(), s.sample + i), random_set(s.step.bounce, purpose),
                    plan.settings.seed);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
