// Time per path of every kernel on every target, beside its float twin run on the same paths in AoS form. The paths are those
// of a render of the test scene, 4096 a call. Every round starts from the same state; restoring it is not timed. After
// timing, what the last round left is held to the kernel's bounds by its twin in double precision, and for kernels that only
// move, count and sum paths compared with the twin's to the bit: the program ends with a message where that fails.
// Run it alone on the machine:
//   build/kernels_bench --benchmark_repetitions=5 --benchmark_report_aggregates_only=true
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <map>
#include <random>
#include <utility>

#include "core/render.h"
#include "core/verify/kernel_case.h"
#include "core/verify/oracle.h"
#include "core/isa.h"
#include "perf/kernel_timing.h"
#include "perf/recorded_paths.h"

namespace lanewise {
namespace {

// Puts back the fields that a kernel writes: found by running it once.
class Restorer {
 public:
  Restorer(const PathState& before, const PathState& after) {
#define LANEWISE_ADD(type, name, meaning) \
  if (std::memcmp(before.name, after.name, kBytes) != 0) fields_.emplace_back(after.name, before.name);
    LANEWISE_PATH_FIELDS(LANEWISE_ADD, LANEWISE_ADD)
#undef LANEWISE_ADD
  }
  void operator()() const {
    for (const auto& [to, from] : fields_) std::memcpy(to, from, kBytes);
  }

 private:
  static constexpr size_t kBytes = kPaths * sizeof(float);
  std::vector<std::pair<void*, const void*>> fields_;
};

void check(const std::string& name, const Plan& plan, const Paths& before, const PathState& after) {
  const verify::Oracle oracle(plan, verify::kernel_case(name));
  verify::Tally tally = oracle.tally();
  for (uint32_t i = 0; i < kPaths; ++i) {
    oracle.compare(before[i], oracle.expect(before[i]), load_path<float>(after, i), tally);
  }
  if (tally.failed > 0) fail(name, tally.first_failure);
  if (!tally.choices_within_bound()) fail(name, std::to_string(tally.moved) + " choices fall otherwise");
}

void time_kernel(benchmark::State& state, const StageTwin& c, const std::string& isa) {
  const Plan& plan = plan_of(c.stage);
  const Paths& paths = paths_of(c.stage);
  const PathBuffer before = buffer_of(paths), buffer = buffer_of(paths);
  const PathState& s = buffer.state();
  choose_isa(isa);
  c.kernel(plan, s, {0, kPaths});
  const Restorer restore(before.state(), s);
  time_rounds(state, restore, [&] { c.kernel(plan, s, {0, kPaths}); });
  check(kStageNames[static_cast<size_t>(c.stage)], plan, paths, s);
}

// As in the scalar path tracer a twin finds its path in the first-level cache: it runs on blocks of paths that fit there. Their
// order is drawn anew in every round, for a branch predictor would learn those of 4096 paths by heart.
void time_twin(benchmark::State& state, const StageTwin& c) {
  constexpr uint32_t kBlock = 64;
  const Plan& plan = plan_of(c.stage);
  Paths paths = paths_of(c.stage);
  std::mt19937 rng(1);
  Path<float> block[kBlock];
  for (auto _ : state) {
    std::ranges::shuffle(paths, rng);
    double seconds = 0;
    for (auto first = paths.begin(); first != paths.end(); first += kBlock) {
      std::copy_n(first, kBlock, block);
      const auto start = SteadyClock::now();
      for (Path<float>& p : block) c.twin(plan, p);
      benchmark::ClobberMemory();
      seconds += seconds_since(start);
    }
    state.SetIterationTime(seconds);
  }
}

// In the order of the data's flow.
std::vector<Subject> all_subjects() {
  std::vector<Subject> subjects = exact_subjects();
  for (const StageTwin& c : stage_twins()) {
    subjects.push_back({kStageNames[static_cast<size_t>(c.stage)],
                        [&c](benchmark::State& state, const std::string& isa) { time_kernel(state, c, isa); },
                        [&c](benchmark::State& state) { time_twin(state, c); }});
  }
  const auto place = [](const Subject& s) { return std::ranges::find(kStageNames, s.name) - std::begin(kStageNames); };
  std::ranges::stable_sort(subjects, {}, place);
  return subjects;
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
      if (variant == "twin") twin_seconds_[kernel] = seconds;
      char line[128];
      std::snprintf(line, sizeof line, "%-18s %-8s %8.2f ns/path", kernel.c_str(), variant.c_str(), 1e9 * seconds);
      GetOutputStream() << line;
      if (variant != "twin") {
        std::snprintf(line, sizeof line, "  %5.1f x the twin", twin_seconds_[kernel] / seconds);
        GetOutputStream() << line;
      }
      GetOutputStream() << "\n";
    }
  }

 private:
  std::map<std::string, double> twin_seconds_;
};

}  // namespace
}  // namespace lanewise

int main(int argc, char** argv) {
  using namespace lanewise;
  const std::vector<Subject> subjects = all_subjects();
  for (const Subject& subject : subjects) {
    benchmark::RegisterBenchmark((subject.name + "/twin").c_str(), subject.time_twin)->UseManualTime();
    for (const std::string& isa : supported_isas()) {
      benchmark::RegisterBenchmark((subject.name + "/" + isa).c_str(), [&subject, isa](benchmark::State& state) {
        subject.time_kernel(state, isa);
        choose_isa("");
      })->UseManualTime();
    }
  }
  benchmark::AddCustomContext("paths", std::to_string(kPaths));
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  Reporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
}
