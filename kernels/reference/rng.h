// Scalar twin of kernels/rng-inl.h: the same integers, so the same numbers in float and in double.
#pragma once

#include <cstdint>

#include "core/dimensions.h"
#include "core/path_state.h"
#include "core/plan.h"
#include "kernels/sobol.h"

namespace lanewise::reference {

template <class T>
struct Random4 {
  T u[4];
};

struct Hash4 {
  uint32_t x, y, z, w;
};

inline Hash4 pcg4d(uint32_t pixel, uint32_t sample, uint32_t set, uint64_t seed) {
  const auto step = [](uint32_t v) { return v * 1664525u + 1013904223u; };
  uint32_t x = step(pixel), y = step(sample), z = step(set ^ static_cast<uint32_t>(seed >> 32));
  uint32_t w = step(static_cast<uint32_t>(seed));
  const auto mix = [&] {
    x += y * w;
    y += z * x;
    z += x * y;
    w += y * z;
  };
  mix();
  x ^= x >> 16;
  y ^= y >> 16;
  z ^= z >> 16;
  w ^= w >> 16;
  mix();
  return {x, y, z, w};
}

inline uint32_t permute(uint32_t x, uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526c56u;
  return x ^ (x * 0x53a22864u);
}

// The point of the pixel's sample as four fractions of 2^32.
inline Hash4 sobol4d(uint32_t pixel, uint32_t sample, uint32_t set, uint64_t seed) {
  const Hash4 seeds = pcg4d(pixel, sample >> kSequenceBits, set, seed);
  const uint32_t shuffle = (seeds.x ^ seeds.z >> 15) + (seeds.y ^ seeds.w << 7);
  const uint32_t index = permute(reverse_bits(sample << (32 - kSequenceBits)), shuffle);
  const auto fraction = [&](uint32_t dimension, uint32_t dimension_seed) {
    uint32_t number = 0, bits = index;
    for (const auto& sums : kSobolTables<4>[dimension].sums) {
      number ^= sums[bits & 15];
      bits >>= 4;
    }
    return reverse_bits(permute(number, dimension_seed));
  };
  return {fraction(0, seeds.x), fraction(1, seeds.y), fraction(2, seeds.z), fraction(3, seeds.w)};
}

template <class T>
Random4<T> draw_random(Sampler sampler, uint32_t pixel, uint32_t sample, uint32_t set, uint64_t seed) {
  const Hash4 bits = (sampler == Sampler::kSobol ? sobol4d : pcg4d)(pixel, sample, set, seed);
  const auto uniform = [](uint32_t x) { return static_cast<T>(x >> 8) * static_cast<T>(0x1p-24); };
  return {{uniform(bits.x), uniform(bits.y), uniform(bits.z), uniform(bits.w)}};
}

template <class T>
Random4<T> draw_set(const Plan& plan, const Path<T>& p, uint32_t set) {
  return draw_random<T>(plan.settings.sampler, p.pixel, p.sample, set, plan.settings.seed ^ p.step.epoch);
}

template <class T>
Random4<T> draw_random(const Plan& plan, const Path<T>& p, uint32_t purpose) {
  return draw_set(plan, p, random_set(p.step.bounce, purpose));
}

template <class T>
Random4<T> draw_direction(const Plan& plan, const Path<T>& p) {
  return draw_set(plan, p, direction_set(p.step.bounce));
}

template <class T>
struct FacetDraw {
  T u, v;
};

template <class T>
FacetDraw<T> draw_facet(const Plan& plan, const Path<T>& p) {
  if (p.step.bounce == 0 && !p.step.from_light) {
    const Random4<T> random = draw_random(plan, p, kSetPath);
    return {random.u[kDrawFacetU], random.u[kDrawFacetV]};
  }
  const Random4<T> random = draw_direction(plan, p);
  return {random.u[kDrawU], random.u[kDrawV]};
}

template <class T>
T draw_glass_lobe(const Plan& plan, const Path<T>& p) {
  return p.step.from_light ? draw_random(plan, p, kSetChoice).u[kDrawLobe]
                           : draw_random(plan, p, kSetPath).u[kDrawGlass];
}

template <class T>
Random4<T> draw_environment(const Plan& plan, const Path<T>& p) {
  return draw_random(plan, p, light_set(plan, p.step));
}

template <class T>
Random4<T> draw_light(const Plan& plan, const Path<T>& p) {
  if (!is_first_light_sample(p.step)) return draw_random(plan, p, light_set(plan, p.step));
  Random4<T> random = draw_random(plan, p, kSetPath);
  random.u[kDrawPatch] = draw_random(plan, p, kSetChoice).u[kDrawFirstPatch];
  return random;
}

}  // namespace lanewise::reference
