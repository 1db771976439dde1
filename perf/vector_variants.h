// Vector functions that are studied beside those of kernels/functions.h: Highway's own, reflectances, and Beckmann's D.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lanewise {

// What the two below are given with: glass, the red of gold, and a polished metal.
inline constexpr float kGlass = 1.5f, kGoldEta = 0.21646f, kGoldK = 3.2390f, kPolished = 0.01f;

// Keeps the compiler from computing with it beforehand: kernels read such numbers anew for every vector.
inline float opaque(float x) {
  asm volatile("" : "+x"(x));
  return x;
}

// x: an angle in turns for kHighwaySin2Pi and kHighwayCos2Pi; the cosine of incidence for reflectances, from vacuum
// into glass, out of it, and on gold; the sine of the half vector's angle for Beckmann's D.
enum class VectorVariant : uint8_t {
  kHighwayExp,
  kHighwayLog,
  kHighwaySin,
  kHighwayCos,
  kHighwaySin2Pi,
  kHighwayCos2Pi,
  kIntoGlassExact,
  kIntoGlassSchlick,
  kIntoGlassCourse,
  kOutOfGlassExact,
  kOutOfGlassSchlick,
  kOutOfGlassCourse,
  kGoldExact,
  kGoldSchlick,
  kGoldCourse,
  kBeckmannStable,  // tan^2 from the half vector's parts, as kernels have it
  kBeckmannNaive,   // tan^2 from its cosine
};

// y[i] = f(x[i]) for i < n, a multiple of kLanes, on the target chosen at the moment.
void apply_variant(VectorVariant f, const float* x, float* y, size_t n);

}  // namespace lanewise
