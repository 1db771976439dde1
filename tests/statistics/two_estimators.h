// Two ways to estimate one picture: is it as bright by either, in every part?
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/statistics/renders.h"
#include "tests/statistics/significance.h"

namespace lanewise::test {

#ifdef NDEBUG
constexpr uint32_t kSeeds = 16, kSpp = 64;
#else
constexpr uint32_t kSeeds = 4, kSpp = 8;
#endif
// Assert builds' few samples do not do for tests of blocks.
constexpr bool kEnough = kSeeds * kSpp > 64;

inline Settings settings_of(uint32_t depth) {
  Settings settings;
  settings.width = 48, settings.height = 36, settings.spp = kSpp, settings.threads = 1, settings.max_depth = depth;
  return settings;
}

struct Difference {
  double mean_p, error;   // of the pictures' means, see Unpaired
  double block_p;         // the least of any block's, for as many blocks
  double variance_ratio;  // of blocks, the second way's over the first's
};

inline Difference compare(Plan first, Plan second) {
  constexpr uint32_t kBlock = 12;
  const std::vector<Image> a = independent_renders(first, simd, 1, kSeeds);
  const std::vector<Image> b = independent_renders(second, simd, 1000, kSeeds);
  const Unpaired pictures = compare_unpaired(a, b, kBlock);
  const double least = *std::ranges::min_element(pictures.block_p), blocks = double(pictures.block_p.size());
  const auto variance = [&](const std::vector<Image>& p) {
    double sum = 0;
    for (const Moments& m : block_moments(p, kBlock)) sum += m.variance();
    return sum;
  };
  return {pictures.mean_p, pictures.error, 1 - std::pow(1 - least, blocks), variance(b) / variance(a)};
}

// The means are for the family to judge.
inline void check_blocks(Family& means, const std::string& name, const Difference& d) {
  CAPTURE(name);
  if (kEnough) CHECK(d.block_p > 0.001);
  if (kEnough) CHECK(d.error < 0.05);
  means.add(name, d.mean_p);
}

}  // namespace lanewise::test
