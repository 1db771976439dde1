#include "core/verify/whole_wave.h"

#include <bit>
#include <random>
#include <vector>

#include "core/path_buffer.h"
#include "core/path_state.h"
#include "kernels/kernels.h"

namespace lanewise::verify {
namespace {

using Rng = std::mt19937;

PathBuffer buffer_for(uint32_t paths) { return PathBuffer(round_up_to_lanes(paths) + kLanes); }

float random_float(Rng& rng) { return std::uniform_real_distribution<float>(0, 3)(rng); }

// The fields that the sort moves for all bins but kFinished.
std::vector<uint32_t> kept_words(const PathState& s, uint32_t i) {
  return {
#define LANEWISE_WORD(type, name, meaning) std::bit_cast<uint32_t>(s.name[i]),
#define LANEWISE_IGNORE(type, name, meaning)
      LANEWISE_PATH_FIELDS(LANEWISE_WORD, LANEWISE_IGNORE)
#undef LANEWISE_IGNORE
#undef LANEWISE_WORD
  };
}

}  // namespace

// Against a stable sort by hand.
double sort_errors(uint32_t paths, uint32_t seed) {
  Rng rng(seed);
  const PathBuffer from = buffer_for(paths), to = buffer_for(paths);
  for (uint32_t i = 0; i < paths; ++i) {
    Path<float> p;
    p.slot = i;
    p.bin = static_cast<uint32_t>(rng() % kBinCount);
    for (float* value : {&p.L_r, &p.o_x, &p.d_y, &p.beta_b, &p.pdf, &p.t, &p.v}) *value = random_float(rng);
    p.prim = static_cast<uint32_t>(rng());
    store_path(from.state(), i, p);
  }
  const Bins bins = sort_by_bin(from.state(), to.state(), {0, paths});
  double wrong = 0;
  for (uint32_t b = 0; b < kBinCount; ++b) {
    uint32_t at = bins[b].begin;
    for (uint32_t i = 0; i < paths; ++i) {
      if (from.state().bin[i] != b) continue;
      const std::vector<uint32_t> want = kept_words(from.state(), i), got = kept_words(to.state(), at++);
      const size_t fields = b == kFinished ? kRetiredFields : want.size();
      for (size_t f = 0; f < fields; ++f) wrong += want[f] != got[f];
    }
    wrong += at != bins[b].end;
  }
  return wrong;
}

double retire_errors(uint32_t paths, uint32_t seed) {
  Rng rng(seed);
  const PathBuffer buffer = buffer_for(paths);
  const PathState& s = buffer.state();
  for (uint32_t i = 0; i < paths; ++i) {
    s.slot[i] = paths - 1 - i;
    for (float* L : {s.L_r, s.L_g, s.L_b}) L[i] = random_float(rng);
  }
  retire(Plan{}, s, {0, paths});
  double wrong = 0;
  for (uint32_t i = 0; i < paths; ++i) {
    const uint32_t slot = s.slot[i];
    wrong += s.result_r[slot] != s.L_r[i] || s.result_g[slot] != s.L_g[i] || s.result_b[slot] != s.L_b[i];
  }
  return wrong;
}

// Against sums one sample at a time; one sample in sixteen is no valid one.
double accumulate_errors(uint32_t paths, uint32_t seed) {
  constexpr uint32_t kSamples = 7;
  Rng rng(seed);
  const PathBuffer buffer = buffer_for(paths);
  const uint32_t pixels = paths / kSamples + 1;
  std::vector<uint32_t> order(pixels);
  for (uint32_t i = 0; i < pixels; ++i) order[i] = pixels - 1 - i;
  PathState s = buffer.state();
  s.batch = {.pixels = order.data(), .samples = kSamples, .paths = paths};
  std::vector<PixelSums> want(pixels), got(pixels);
  uint32_t invalid = 0;
  for (uint32_t i = 0; i < paths; ++i) {
    s.result_r[i] = rng() % 16 == 0 ? -1 : random_float(rng);
    s.result_g[i] = random_float(rng), s.result_b[i] = random_float(rng);
    const bool valid = s.result_r[i] >= 0;
    invalid += !valid;
    PixelSums& sums = want[order[i / kSamples]];
    valid ? sums.add(s.result_r[i], s.result_g[i], s.result_b[i]) : sums.add(0, 0, 0);
  }
  double wrong = accumulate(s, got.data()) != invalid;
  for (uint32_t i = 0; i < pixels; ++i) wrong += !(got[i] == want[i]);
  return wrong;
}

double count_shadow_rays_errors(uint32_t paths, uint32_t seed) {
  Rng rng(seed);
  const PathBuffer buffer = buffer_for(paths);
  const PathState& s = buffer.state();
  uint32_t want = 0;
  for (uint32_t i = 0; i < paths; ++i) {
    float* const channels[] = {s.c_r, s.c_g, s.c_b};
    float* channel = channels[rng() % 3];
    channel[i] = rng() % 4 == 0 ? 0 : 1e-30f;
    want += channel[i] != 0;
  }
  return count_shadow_rays(s, {0, paths}) != want;
}

}  // namespace lanewise::verify
