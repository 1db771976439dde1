// Which random numbers each decision draws. All come in sets of four, a pure function of (seed, pixel, sample, set), so
// a picture depends on nothing else; no two decisions of one path share a number. With --sampler sobol a set is four dimensions of a
// low-discrepancy sequence over the pixel's samples, so that what acts together best lies in one set: the way in which a path
// comes to a vertex, and what it does there. (At the first vertex of a camera path its light sample and its facet have the same two
// numbers, both beside the place in the pixel: one ends a path and the other goes on with it, and no estimate multiplies them.)
#pragma once

#include <cstdint>

#include "core/path_state.h"

namespace lanewise {

// Sets of a bounce; kSetLight has one for each light and sample of it, the environment as the last, but for the very first of
// the scene's own, which is kSetPath's: add light * light_samples + light_sample. Those of connections follow, by light and
// sample again.
enum RandomPurpose : uint32_t {
  // The way to the vertex (place in the pixel, or direction from the one before); its first light sample, and what
  // CameraDraw names. Of a light path at bounce 0: its point of the lamp, and its direction.
  kSetPath = 0,
  // Lobe (at smooth glass: of light paths), roulette, patch of the first light sample. Of a light path at bounce 0: patch
  // and caster.
  kSetChoice = 1,
  kSetLens = 2,               // point on the lens (of camera paths at bounce 0; where a light path is seen, at any)
  kSetLight = 3,              // a light sample
  kSetsPerBounce = 1u << 16,  // so at most 65,533 samples of lights and connections a vertex, and 65,535 bounces
};

// Which of a set's four numbers.
enum PathDraw : uint32_t { kDrawU = 0, kDrawV = 1, kDrawEmitU = 2, kDrawEmitV = 3 };  // the last two: of light paths
// Of camera paths: the lobe at smooth glass, which takes no light sample; the facet of the first vertex.
enum CameraDraw : uint32_t { kDrawGlass = 2, kDrawFacetU = 2, kDrawFacetV = 3 };
enum ChoiceDraw : uint32_t { kDrawLobe = 0, kDrawRoulette = 1, kDrawFirstPatch = 2, kDrawCaster = 3 };
enum LightDraw : uint32_t { kDrawPatch = 0, kDrawSphere = 1, kDrawLightU = 2, kDrawLightV = 3 };
enum EnvironmentDraw : uint32_t { kDrawSkyRow = 0, kDrawSkyColumn = 1, kDrawSkyX = 2, kDrawSkyY = 3 };

constexpr uint32_t random_set(uint32_t bounce, uint32_t purpose) { return bounce * kSetsPerBounce + purpose; }

// Of the direction in which a path leaves the vertex of that bounce.
constexpr uint32_t direction_set(uint32_t bounce) { return random_set(bounce + 1, kSetPath); }

constexpr bool is_first_light_sample(const Step& step) { return step.light == 0 && step.light_sample == 0; }

// What the numbers of samples beyond the first 2^32 of a pixel have in their seed beside the user's: a permutation of sample / 2^32,
// 0 for 0, all of whose bits hang on all (the finaliser of splitmix64: Steele, Lea & Flood, OOPSLA 2014).
constexpr uint64_t mix_epoch(uint64_t x) {
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
  x = (x ^ x >> 27) * 0x94d049bb133111ebu;
  return x ^ x >> 31;
}
constexpr uint64_t epoch_of(uint64_t sample) { return mix_epoch(sample >> 32); }

// The same for the light paths of a lamp: path `number` of passes with that pass / 2^32. It has the numbers of sample
// number % 2^kSequenceBits of "pixel" number / 2^kSequenceBits: those of a sequence share a picture, not a pixel.
constexpr uint64_t light_path_epoch(uint32_t light, uint64_t number, uint64_t pass) {
  const uint64_t epoch = mix_epoch((uint64_t{1} << 40) + light + (number >> 48 << 42));
  return pass >> 32 == 0 ? epoch : epoch ^ mix_epoch((uint64_t{1} << 41) + (pass >> 32));
}

// Where a second, independent estimate of a pixel begins to count its samples; so a first one has no more than these.
constexpr uint64_t kSecondEstimate = uint64_t{1} << 63;

// A Sobol sequence is this long; a pixel's further samples come from further sequences, scrambled afresh. Samples
// first .. first + 2^k - 1 are a net of it (at their best together) where first is a multiple of 2^k.
constexpr uint32_t kSequenceBits = 16;

constexpr uint32_t light_path_pixel(uint64_t number) { return static_cast<uint32_t>(number >> kSequenceBits); }
constexpr uint32_t light_path_sample(uint64_t number) {
  return static_cast<uint32_t>(number) & ((1u << kSequenceBits) - 1);
}

}  // namespace lanewise
