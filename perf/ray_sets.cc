#include "perf/ray_sets.h"

#include <algorithm>
#include <numeric>

#include "kernels/kernels.h"

namespace lanewise::perf {
namespace {

// Paths [range) for which `wanted` holds go to the end of the set, wave after full wave.
template <class Wanted>
void append(RaySet& set, const PathState& s, Range range, uint32_t wave, Wanted wanted) {
  for (uint32_t i = range.begin; i < range.end; ++i) {
    if (!wanted(i)) continue;
    if (set.waves.empty() || set.counts.back() == wave) {
      set.waves.emplace_back(wave);
      set.counts.push_back(0);
    }
    store_path(set.waves.back().state(), set.counts.back()++, load_path<float>(s, i));
  }
}

}  // namespace

size_t RaySet::rays() const { return std::accumulate(counts.begin(), counts.end(), size_t{0}); }

std::vector<RaySet> collect_rays(const Plan& plan, uint32_t bounces) {
  const uint32_t wave = plan.settings.wave;
  std::vector<RaySet> sets(bounces + 2);
  for (uint32_t b = 0; b <= bounces; ++b) sets[b].name = b == 0 ? "camera" : "bounce " + std::to_string(b);
  RaySet& shadow = sets.back();
  shadow.name = "shadow";
  shadow.shadow = true;

  const uint32_t all = plan.settings.width * plan.settings.height;
  std::vector<uint32_t> pixels(all);
  std::iota(pixels.begin(), pixels.end(), 0u);
  PathBuffer buffers[2] = {PathBuffer(wave), PathBuffer(wave)};
  for (uint32_t first = 0; first < all; first += wave) {
    PathState s = buffers[0].state(), spare = buffers[1].state();
    spare.result_r = s.result_r, spare.result_g = s.result_g, spare.result_b = s.result_b;
    const uint32_t paths = std::min(wave, all - first);
    s.batch = {.pixels = pixels.data(), .samples = 1, .first_sample = 0, .first_path = first, .paths = paths};
    Range live{0, paths};
    generate(plan, s, live);
    for (uint32_t bounce = 0; bounce <= bounces && live.size() > 0; ++bounce) {
      s.step.bounce = bounce;
      append(sets[bounce], s, live, wave, [&](uint32_t i) {
        return s.slot[i] != s.capacity && std::max({s.beta_r[i], s.beta_g[i], s.beta_b[i]}) > 0;
      });
      intersect(plan, s, live);
      const Bins bins = sort_by_bin(s, spare, live);
      spare.step = s.step, spare.batch = s.batch;
      std::swap(s, spare);
      live = bins.span(0, kSurfaceBins);
      surface(plan, s, live);
      const Range rough = bins.span(0, kRoughBins);
      if (rough.size() > 0) {
        sample_light(plan, s, rough);
        light_diffuse(plan, s, bins[kDiffuse]);
        light_microfacet(plan, s, bins[kMicrofacet]);
        append(shadow, s, rough, wave, [&](uint32_t i) {
          return s.slot[i] != s.capacity && std::max({s.c_r[i], s.c_g[i], s.c_b[i]}) != 0;
        });
      }
      shade_diffuse(plan, s, bins[kDiffuse]);
      shade_microfacet(plan, s, bins[kMicrofacet]);
      shade_mirror(plan, s, bins[kMirror]);
      shade_glass(plan, s, bins[kGlass]);
      if (bounce >= kRouletteBounce) roulette(plan, s, live);
    }
  }
  return sets;
}

}  // namespace lanewise::perf
