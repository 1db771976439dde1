#include <string>

#include "core/render.h"
#include "core/isa.h"
#include "kernels/kernels.h"
#include "kernels/reference/intersect.h"
#include "perf/kernel_timing.h"

namespace lanewise {
namespace {

// What the intersect of a bounce leaves behind.
const Paths& hit_paths() {
  static const Paths paths = [] {
    Paths all = paths_of(Stage::kIntersect);
    for (uint32_t i = 0; i < kPaths; ++i) {
      reference::intersect(plan_of(Stage::kIntersect), all[i]);
      all[i].slot = i;
    }
    return all;
  }();
  return paths;
}

bool same_kept_fields(const Path<float>& a, const Path<float>& b) {
  bool same = true;
#define LANEWISE_SAME(type, name, meaning) same &= a.name == b.name;
#define LANEWISE_IGNORE(type, name, meaning)
  LANEWISE_PATH_FIELDS(LANEWISE_SAME, LANEWISE_IGNORE)
#undef LANEWISE_IGNORE
#undef LANEWISE_SAME
  return same;
}

bool same_retired_fields(const Path<float>& a, const Path<float>& b) {
  return a.slot == b.slot && a.L_r == b.L_r && a.L_g == b.L_g && a.L_b == b.L_b;
}

// A counting sort of whole paths.
void sort_twin(const Paths& from, Paths& to) {
  uint32_t next[kBinCount + 1] = {};
  for (const Path<float>& p : from) ++next[p.bin + 1];
  for (uint32_t b = 0; b < kBinCount; ++b) next[b + 1] += next[b];
  for (const Path<float>& p : from) to[next[p.bin]++] = p;
}

void time_sort(benchmark::State& state, const std::string& isa) {
  const PathBuffer from = buffer_of(hit_paths()), to(kPaths);
  choose_isa(isa);
  Bins bins;
  time_rounds(
      state, [] {},
      [&] {
        bins = sort_by_bin(from.state(), to.state(), {0, kPaths});
      });
  Paths want(kPaths);
  sort_twin(hit_paths(), want);
  uint32_t at = 0;
  for (uint32_t b = 0; b < kBinCount; ++b) {
    for (uint32_t i = bins[b].begin; i < bins[b].end; ++i, ++at) {
      const Path<float> got = load_path<float>(to.state(), i);
      const bool same = b == kFinished ? same_retired_fields(got, want[at]) : same_kept_fields(got, want[at]);
      if (!same || want[at].bin != b) fail("sort", "path " + std::to_string(at));
    }
  }
}

void time_sort_twin(benchmark::State& state) {
  Paths to(kPaths);
  time_rounds(
      state, [] {}, [&] { sort_twin(hit_paths(), to); });
}

struct Rgb {
  float r, g, b;
};

void time_retire(benchmark::State& state, const std::string& isa) {
  const PathBuffer buffer = buffer_of(hit_paths());
  const PathState& s = buffer.state();
  choose_isa(isa);
  time_rounds(
      state, [] {},
      [&] {
        retire(plan_of(Stage::kRetire), s, {0, kPaths});
      });
  for (const Path<float>& p : hit_paths()) {
    if (s.result_r[p.slot] != p.L_r || s.result_g[p.slot] != p.L_g || s.result_b[p.slot] != p.L_b) {
      fail("retire", "slot " + std::to_string(p.slot));
    }
  }
}

void time_retire_twin(benchmark::State& state) {
  std::vector<Rgb> results(kPaths);
  time_rounds(
      state, [] {},
      [&] {
        for (const Path<float>& p : hit_paths()) results[p.slot] = {p.L_r, p.L_g, p.L_b};
      });
}

using Sums = std::vector<PixelSums>;

void accumulate_twin(const Paths& paths, Sums& film) {
  for (const Path<float>& p : paths) film[p.slot / kSamples].add(p.L_r, p.L_g, p.L_b);
}

void time_accumulate(benchmark::State& state, const std::string& isa) {
  const PathBuffer buffer = buffer_of(hit_paths());
  const PathState& s = buffer.state();
  retire(plan_of(Stage::kRetire), s, {0, kPaths});
  choose_isa(isa);
  Sums film, want(kSide * kSide);
  time_rounds(
      state, [&] { film.assign(kSide * kSide, {}); }, [&] { accumulate(s, film.data()); });
  accumulate_twin(hit_paths(), want);
  if (film != want) fail("accumulate", "the sums");
}

void time_accumulate_twin(benchmark::State& state) {
  Sums film;
  time_rounds(
      state, [&] { film.assign(kSide * kSide, {}); }, [&] { accumulate_twin(hit_paths(), film); });
}

uint32_t count_twin(const Paths& paths) {
  uint32_t rays = 0;
  for (const Path<float>& p : paths) rays += p.c_r != 0 || p.c_g != 0 || p.c_b != 0;
  return rays;
}

void time_count(benchmark::State& state, const std::string& isa) {
  const Paths& paths = paths_of(Stage::kOcclude);
  const PathBuffer buffer = buffer_of(paths);
  choose_isa(isa);
  uint32_t rays = 0;
  time_rounds(
      state, [] {},
      [&] {
        rays = count_shadow_rays(buffer.state(), {0, kPaths});
      });
  if (rays != count_twin(paths)) fail("count_shadow_rays", std::to_string(rays));
}

void time_count_twin(benchmark::State& state) {
  time_rounds(
      state, [] {}, [&] { benchmark::DoNotOptimize(count_twin(paths_of(Stage::kOcclude))); });
}

}  // namespace

std::vector<Subject> exact_subjects() {
  return {{"sort", time_sort, time_sort_twin},
          {"retire", time_retire, time_retire_twin},
          {"count_shadow_rays", time_count, time_count_twin},
          {"accumulate", time_accumulate, time_accumulate_twin}};
}

}  // namespace lanewise
