// Which random numbers each decision draws. All come in sets of four, a pure function of (seed, pixel, sample, set), so
// a picture depends on nothing else; no two decisions share a set. With --sampler sobol a set is four dimensions of a
// low-discrepancy sequence over the pixel's samples, so that what is decided together lies in one set.
#pragma once

#include <cstdint>

namespace lanewise {

// Sets within a bounce; kSetLight has one for each light and sample of it: add light * light_samples + light_sample.
enum RandomPurpose : uint32_t {
  kSetCamera = 0,             // x and y in the pixel, u and v on the lens (bounce 0 only)
  kSetBsdf = 1,               // two for the direction, one for the lobe, one for the roulette
  kSetLight = 2,              // choice of the patch, u and v on it
  kSetsPerBounce = 1u << 16,  // so at most 65,534 light samples a vertex, and 65,535 bounces
};

// Within a set of kSetBsdf: which of the four.
enum BsdfDraw : uint32_t { kDrawU = 0, kDrawV = 1, kDrawLobe = 2, kDrawRoulette = 3 };

constexpr uint32_t random_set(uint32_t bounce, uint32_t purpose) { return bounce * kSetsPerBounce + purpose; }

// A Sobol sequence is this long; a pixel's further samples come from further sequences, scrambled afresh. Samples
// first .. first + 2^k - 1 are a net of it (at their best together) where first is a multiple of 2^k.
constexpr uint32_t kSequenceBits = 16;

}  // namespace lanewise
