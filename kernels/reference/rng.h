// Scalar twin of kernels/rng-inl.h: the same integers, so the same numbers in float and in double.
#pragma once

#include <cstdint>

#include "core/dimensions.h"
#include "core/path_state.h"
#include "core/plan.h"

namespace lanewise::reference {

template <class T>
struct Random4 {
  T u[4];
};

template <class T>
Random4<T> draw_random(uint32_t pixel, uint32_t sample, uint32_t set, uint64_t seed) {
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
  const auto uniform = [](uint32_t bits) { return static_cast<T>(bits >> 8) * static_cast<T>(0x1p-24); };
  return {{uniform(x), uniform(y), uniform(z), uniform(w)}};
}

template <class T>
Random4<T> draw_random(const Plan& plan, const Path<T>& p, uint32_t purpose) {
  return draw_random<T>(p.pixel, p.sample, random_set(p.step.bounce, purpose), plan.settings.seed);
}

}  // namespace lanewise::reference
