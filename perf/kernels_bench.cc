// Time per path of every kernel that shades, on every target, beside its float twin run on the same paths in AoS form.
// Counter x_twin: how many times faster than the twin. Run it alone on the machine:
//   build/kernels_bench --benchmark_repetitions=5 --benchmark_report_aggregates_only
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <map>
#include <string>

#include "core/path_buffer.h"
#include "core/render.h"
#include "kernels/kernels.h"
#include "kernels/reference/emission.h"
#include "kernels/reference/roulette.h"
#include "kernels/reference/sample_light.h"
#include "kernels/reference/shade_diffuse.h"
#include "kernels/reference/shade_glass.h"
#include "kernels/reference/shade_microfacet.h"
#include "kernels/reference/shade_mirror.h"
#include "kernels/reference/surface.h"
#include "core/verify/random_path.h"
#include "core/verify/test_scene.h"

namespace lanewise {
namespace {

constexpr uint32_t kPaths = 4096;

struct Case {
  const char* name;
  Kernel* kernel;
  void (*twin)(const Plan&, Path<float>&);
  Bin bin;  // the material that the paths have hit
};

const Case kCases[] = {
    {"surface", surface, reference::surface<float>, kDiffuse},
    {"sample_light", sample_light, reference::sample_light<float>, kDiffuse},
    {"light_diffuse", light_diffuse, reference::light_diffuse<float>, kDiffuse},
    {"shade_diffuse", shade_diffuse, reference::shade_diffuse<float>, kDiffuse},
    {"light_microfacet", light_microfacet, reference::light_microfacet<float>, kMicrofacet},
    {"shade_microfacet", shade_microfacet, reference::shade_microfacet<float>, kMicrofacet},
    {"shade_mirror", shade_mirror, reference::shade_mirror<float>, kMirror},
    {"shade_glass", shade_glass, reference::shade_glass<float>, kGlass},
    {"emission", emission, reference::emission<float>, kEmitter},
    {"roulette", roulette, reference::roulette<float>, kDiffuse},
};

const Plan& plan() {
  static const Plan instance = make_plan(test::test_scene(), {});
  return instance;
}

std::vector<Path<float>> make_paths(Bin bin) {
  std::mt19937 rng(1);
  std::vector<Path<float>> paths(kPaths);
  for (uint32_t i = 0; i < kPaths; ++i) {
    do {
      test::fill_random(plan(), rng, paths[i], i);
    } while (paths[i].bin != bin);
    paths[i].step.bounce = kRouletteBounce;
  }
  return paths;
}

double& twin_seconds(const std::string& name) {
  static std::map<std::string, double> seconds;
  return seconds[name];
}

// The throughput is reset in each round, in both forms, so that it does not shrink to subnormal numbers.
void run_twin(benchmark::State& state, const Case& c) {
  std::vector<Path<float>> paths = make_paths(c.bin);
  for (auto _ : state) {
    for (Path<float>& p : paths) {
      p.beta_r = p.beta_g = p.beta_b = 1;
      c.twin(plan(), p);
    }
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * kPaths);
}

void run_kernel(benchmark::State& state, const Case& c, const std::string& isa) {
  choose_isa(isa);
  PathBuffer buffer(kPaths);
  PathState& s = buffer.state();
  const std::vector<Path<float>> paths = make_paths(c.bin);
  for (uint32_t i = 0; i < kPaths; ++i) store_path(s, i, paths[i]);
  s.step.bounce = kRouletteBounce;
  for (auto _ : state) {
    for (float* beta : {s.beta_r, s.beta_g, s.beta_b}) std::fill_n(beta, kPaths, 1.0f);
    c.kernel(plan(), s, {0, kPaths});
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * kPaths);
  choose_isa("");
}

// Prints ns per path and, for kernels, how many times faster than the twin that ran before.
class Reporter : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type == Run::RT_Aggregate && run.aggregate_name != "median") continue;
      const std::string full = run.run_name.function_name;
      const std::string kernel = full.substr(0, full.find('/')), variant = full.substr(full.find('/') + 1);
      const double seconds = run.GetAdjustedRealTime() / benchmark::GetTimeUnitMultiplier(run.time_unit) / kPaths;
      if (variant == "twin") twin_seconds(kernel) = seconds;
      char line[128];
      std::snprintf(line, sizeof line, "%-18s %-8s %8.2f ns/path", kernel.c_str(), variant.c_str(), 1e9 * seconds);
      GetOutputStream() << line;
      if (variant != "twin") {
        std::snprintf(line, sizeof line, "  %5.1f x the twin", twin_seconds(kernel) / seconds);
        GetOutputStream() << line;
      }
      GetOutputStream() << "\n";
    }
  }
};

}  // namespace
}  // namespace lanewise

int main(int argc, char** argv) {
  using namespace lanewise;
  for (const Case& c : kCases) {
    const std::string name = c.name;
    benchmark::RegisterBenchmark((name + "/twin").c_str(), [&c](benchmark::State& s) { run_twin(s, c); });
    for (const std::string& isa : supported_isas()) {
      benchmark::RegisterBenchmark((name + "/" + isa).c_str(),
                                   [&c, isa](benchmark::State& s) { run_kernel(s, c, isa); });
    }
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  Reporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
}
