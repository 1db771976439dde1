// What the benchmarks of kernels share: the waves that they work on, and rounds that start alike.
#pragma once

#include <benchmark/benchmark.h>

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "core/path_buffer.h"
#include "core/plan.h"
#include "core/stages.h"

namespace lanewise {

constexpr uint32_t kPaths = 4096;  // of a wave: all samples of a picture of kSide x kSide pixels
constexpr uint32_t kSide = 16, kSamples = 16;

using Paths = std::vector<Path<float>>;
using SteadyClock = std::chrono::steady_clock;

// A kernel to measure: on an instruction set, and its scalar twin.
struct Subject {
  std::string name;
  std::function<void(benchmark::State&, const std::string& isa)> time_kernel;
  std::function<void(benchmark::State&)> time_twin;
};
// Of sort, retire, accumulate and count_shadow_rays, which are held to their twins to the bit.
std::vector<Subject> exact_subjects();

// The test scene, with what the stage needs switched on.
const Plan& plan_of(Stage stage);
// A wave of paths as they come to the stage.
const Paths& paths_of(Stage stage);
PathBuffer buffer_of(const Paths& paths);

// Ends the program: the kernel did not do what it must, on the chosen instruction set.
[[noreturn]] void fail(const std::string& kernel, const std::string& what);

inline double seconds_since(SteadyClock::time_point start) {
  return std::chrono::duration<double>(SteadyClock::now() - start).count();
}

// Counts only what run() takes.
template <class Restore, class Run>
void time_rounds(benchmark::State& state, const Restore& restore, const Run& run) {
  for (auto _ : state) {
    restore();
    const auto start = SteadyClock::now();
    run();
    benchmark::ClobberMemory();
    state.SetIterationTime(seconds_since(start));
  }
}

}  // namespace lanewise
