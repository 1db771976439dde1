// Random numbers, a pure function of (seed, pixel, sample, set), four a set. Scalar twin: kernels/reference/rng.h.
//
// random: independent numbers, by the hash pcg4d of Jarzynski & Olano, Hash Functions for GPU Rendering, JCGT 9(3), 2020.
// sobol: a pixel's samples are the points, in shuffled order, of a four-dimensional Sobol sequence with Owen scrambling, for
// every set another (Burley, Practical Hash-based Owen Scrambling, JCGT 9(4), 2020): sets are independent of each other, and so
// are pixels. The hash makes the seeds. The permutation is that of Laine & Karras in Vegdahl's version, which has fewer
// patterns left (psychopath.io, Building a Better LK Hash, 2021).
#if defined(LANEWISE_KERNELS_RNG_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LANEWISE_KERNELS_RNG_INL_H_
#undef LANEWISE_KERNELS_RNG_INL_H_
#else
#define LANEWISE_KERNELS_RNG_INL_H_
#endif

#include "core/dimensions.h"
#include "core/plan.h"
#include "kernels/simd-inl.h"
#include "kernels/sobol.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// Four uniforms in [0, 1), multiples of 2^-24.
struct Random4 {
  VF u[4];
};

HWY_INLINE VF ToUniform(VU bits) {
  return hn::Mul(hn::ConvertTo(DF(), hn::BitCast(DI(), hn::ShiftRight<8>(bits))), Splat(0x1p-24f));
}

struct Hash4 {
  VU x, y, z, w;
};

HWY_INLINE Hash4 Pcg4d(VU pixel, VU sample, uint32_t set, uint64_t seed) {
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
  return {x, y, z, w};
}

HWY_INLINE VU ReverseBits(VU v) {
  const DU d;
#if HWY_TARGET == HWY_SCALAR
  return hn::Set(d, reverse_bits(hn::GetLane(v)));
#else
  const hn::Repartition<uint8_t, DU> d8;
  // By nibbles, then the bytes of each lane.
  alignas(16) static constexpr uint8_t kReversed[16] = {0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15};
  alignas(16) static constexpr uint8_t kBytes[16] = {3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12};
  const auto table = hn::LoadDup128(d8, kReversed);
  const VU low_half = hn::Set(d, 0x0F0F0F0Fu);
  const auto low = hn::TableLookupBytes(table, hn::BitCast(d8, hn::And(v, low_half)));
  const auto high = hn::TableLookupBytes(table, hn::BitCast(d8, hn::And(hn::ShiftRight<4>(v), low_half)));
  const VU swapped = hn::Or(hn::ShiftLeft<4>(hn::BitCast(d, low)), hn::BitCast(d, high));
  return hn::BitCast(d, hn::TableLookupBytes(hn::BitCast(d8, swapped), hn::LoadDup128(d8, kBytes)));
#endif
}

// A random permutation of the numbers in which every bit hangs on the lower ones alone: on reversed bits, Owen's scrambling.
HWY_INLINE VU Permute(VU x, VU seed) {
  const DU d;
  x = hn::Xor(x, hn::Mul(x, hn::Set(d, 0x3d20adeau)));
  x = hn::Add(x, seed);
  x = hn::Mul(x, hn::Or(hn::ShiftRight<16>(seed), hn::Set(d, 1)));
  x = hn::Xor(x, hn::Mul(x, hn::Set(d, 0x05526c56u)));
  return hn::Xor(x, hn::Mul(x, hn::Set(d, 0x53a22864u)));
}

// The reversed number of a dimension: the index's bits times its matrix, by groups of as many bits as lanes can be looked up
// among.
HWY_INLINE VU SobolNumber(VU reversed_index, uint32_t dimension) {
  const DU d;
  constexpr size_t kLookedUp = hn::MaxLanes(DU());  // one lane looks up in memory
  constexpr uint32_t kBits = kLookedUp == 4 ? 2 : kLookedUp == 8 ? 3 : 4;
  const auto& table = kSobolTables<kBits>[dimension];
  VU number = hn::Zero(d), bits = reversed_index;
  const VU group = hn::Set(d, (1u << kBits) - 1);
  for (const auto& sums : table.sums) {
    const VU value = hn::And(bits, group);
#if HWY_TARGET == HWY_SCALAR
    number = hn::Xor(number, hn::Set(d, sums[hn::GetLane(value)]));
#else
    number = hn::Xor(number, hn::TableLookupLanes(hn::Load(d, sums), hn::IndicesFromVec(d, value)));
#endif
    bits = hn::ShiftRight<kBits>(bits);
  }
  return number;
}

HWY_INLINE Random4 DrawSobol(VU pixel, VU sample, uint32_t set, uint64_t seed) {
  const Hash4 seeds = Pcg4d(pixel, hn::ShiftRight<kSequenceBits>(sample), set, seed);
  // Shuffled so that the first 2^k indices stay together: a permutation of the reversed index.
  const VU shuffle =
      hn::Add(hn::Xor(seeds.x, hn::ShiftRight<15>(seeds.z)), hn::Xor(seeds.y, hn::ShiftLeft<7>(seeds.w)));
  const VU index = Permute(ReverseBits(hn::ShiftLeft<32 - kSequenceBits>(sample)), shuffle);
  const auto draw = [&](uint32_t dimension, VU dimension_seed) HWY_ATTR {
    return ToUniform(ReverseBits(Permute(SobolNumber(index, dimension), dimension_seed)));
  };
  return {{draw(0, seeds.x), draw(1, seeds.y), draw(2, seeds.z), draw(3, seeds.w)}};
}

HWY_INLINE Random4 DrawRandom(Sampler sampler, VU pixel, VU sample, uint32_t set, uint64_t seed) {
  if (sampler == Sampler::kSobol) return DrawSobol(pixel, sample, set, seed);
  const Hash4 hash = Pcg4d(pixel, sample, set, seed);
  return {{ToUniform(hash.x), ToUniform(hash.y), ToUniform(hash.z), ToUniform(hash.w)}};
}

// A set of the paths at slot i.
HWY_INLINE Random4 DrawSet(const Plan& plan, const PathState& s, size_t i, uint32_t set) {
  return DrawRandom(plan.settings.sampler, hn::Load(DU(), s.pixel + i), hn::Load(DU(), s.sample + i), set,
                    plan.settings.seed ^ s.step.epoch);
}
// Of their bounce.
HWY_INLINE Random4 DrawRandom(const Plan& plan, const PathState& s, size_t i, uint32_t purpose) {
  return DrawSet(plan, s, i, random_set(s.step.bounce, purpose));
}
// Of the direction in which they go on.
HWY_INLINE Random4 DrawDirection(const Plan& plan, const PathState& s, size_t i) {
  return DrawSet(plan, s, i, direction_set(s.step.bounce));
}
// Of the facet that reflects or refracts them.
struct FacetDraw {
  VF u, v;
};
HWY_INLINE FacetDraw DrawFacet(const Plan& plan, const PathState& s, size_t i) {
  if (s.step.bounce == 0 && !s.step.from_light) {
    const Random4 random = DrawRandom(plan, s, i, kSetPath);
    return {random.u[kDrawFacetU], random.u[kDrawFacetV]};
  }
  const Random4 random = DrawDirection(plan, s, i);
  return {random.u[kDrawU], random.u[kDrawV]};
}
// Of the lobe at smooth glass.
HWY_INLINE VF DrawGlassLobe(const Plan& plan, const PathState& s, size_t i) {
  return s.step.from_light ? DrawRandom(plan, s, i, kSetChoice).u[kDrawLobe]
                           : DrawRandom(plan, s, i, kSetPath).u[kDrawGlass];
}
// Of the environment sample of their step: EnvironmentDraw.
HWY_INLINE Random4 DrawEnvironment(const Plan& plan, const PathState& s, size_t i) {
  return DrawRandom(plan, s, i, light_set(plan, s.step));
}
// Of the light sample of their step: LightDraw.
HWY_INLINE Random4 DrawLight(const Plan& plan, const PathState& s, size_t i) {
  if (!is_first_light_sample(s.step)) return DrawRandom(plan, s, i, light_set(plan, s.step));
  Random4 random = DrawRandom(plan, s, i, kSetPath);
  if (!plan.lights.empty() && plan.lights[0].patches > 1)
    random.u[kDrawPatch] = DrawRandom(plan, s, i, kSetChoice).u[kDrawFirstPatch];
  return random;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#endif
