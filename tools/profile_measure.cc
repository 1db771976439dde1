#include "tools/profile_measure.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fstream>
#include <limits>

#include "core/explain.h"
#include "core/render.h"
#include "core/stage_fields.h"
#include "core/stats.h"
#include "core/isa.h"
#include "tools/text.h"

namespace lanewise {
namespace {

double seconds_of(uint64_t nanoseconds) { return 1e-9 * static_cast<double>(nanoseconds); }

// Of all threads: what others do on the machine disturbs it less than it does the wall clock.
double process_cpu_seconds() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

struct Run {
  RenderResult result;
  double cpu_seconds = 0;
};

Run run_once(const Plan& plan, bool clock) {
  const double before = process_cpu_seconds();
  Run run{render(plan, {}, {.clock = clock})};
  run.cpu_seconds = process_cpu_seconds() - before;
  return run;
}

// Seconds of one thread that counting and clocking take in a render of so many waves and calls: of empty ones of both. The
// least of some trials, so that what else the machine does is not in it.
double clock_seconds(uint64_t waves, uint64_t calls) {
  constexpr uint32_t kTrials = 20, kWaves = 20;
  const auto calls_per_wave =
      static_cast<uint32_t>(std::clamp<uint64_t>(calls / std::max<uint64_t>(waves, 1), 1, 10'000));
  double least = std::numeric_limits<double>::infinity();
  for (uint32_t trial = 0; trial < kTrials; ++trial) {
    Profiler profiler({.clock = true});
    const auto start = std::chrono::steady_clock::now();
    for (uint32_t w = 0; w < kWaves; ++w) {
      const auto wave = profiler.wave(4096);
      for (uint32_t c = 0; c < calls_per_wave; ++c)
        profiler.call(static_cast<Stage>(c % kStageCount), c % 8, 4096, 4096);
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    least = std::min(least, elapsed.count());
  }
  return least / kWaves * static_cast<double>(waves);
}

// Of all paths, at the pace of those in calm waves; if there were none, of all.
double calm_seconds(const StageCounter& c) {
  if (c.calm_paths == 0) return seconds_of(c.nanoseconds);
  return seconds_of(c.calm_nanoseconds) * static_cast<double>(c.paths) / static_cast<double>(c.calm_paths);
}

StageWork work_of(const StageCounter& c) {
  const QueueLengths& l = c.lengths;
  return {c.calls, c.paths, c.lanes, c.rays, {l.min(), l.quantile(0.25), l.quantile(0.5), l.quantile(0.75), l.max()}};
}

// See StageWork::bytes.
double bytes_of(Stage stage, const std::array<StageCounter, kStageCount>& bounce) {
  const auto counter = [&](Stage s) -> const StageCounter& { return bounce[static_cast<size_t>(s)]; };
  const KernelFields& fields = stage_fields(stage);
  double moved = (words(fields.reads) + words(fields.writes)) * static_cast<double>(counter(stage).lanes);
  if (stage ==
      Stage::kSort) {  // what retires at its own bounce, not having met an emitter or the sky, went to kFinished
    const uint64_t lit = counter(Stage::kEmission).paths + counter(Stage::kEnvironment).paths;
    const auto finished = static_cast<double>(counter(Stage::kRetire).paths - lit);
    moved -= 2.0 * (words("KEPT") - kRetiredFields) * finished;
  }
  return 4 * moved;
}

StageReport report_stage(Stage stage, const std::vector<Profile>& runs) {
  const KernelFields& fields = stage_fields(stage);
  const auto i = static_cast<size_t>(stage);
  StageReport report{kStageNames[i], words(fields.reads), words(fields.writes), work_of(runs[0].total(stage)), {}, {}};
  std::vector<double> run_seconds(runs.size());
  for (size_t b = 0; b < runs[0].bounces.size(); ++b) {
    std::vector<double> seconds;
    for (size_t run = 0; run < runs.size(); ++run) {
      seconds.push_back(calm_seconds(runs[run].bounces[b][i]));
      run_seconds[run] += seconds.back();
    }
    StageWork work = work_of(runs[0].bounces[b][i]);
    work.seconds = median(seconds);
    work.bytes = bytes_of(stage, runs[0].bounces[b]);
    report.total.seconds += work.seconds;
    report.total.bytes += work.bytes;
    report.bounces.push_back(work);
  }
  while (!report.bounces.empty() && report.bounces.back().calls == 0) report.bounces.pop_back();
  for (const double seconds : run_seconds) {
    report.run_ns.push_back(1e9 * seconds / static_cast<double>(std::max<uint64_t>(report.total.paths, 1)));
  }
  return report;
}

// What the clocks tell of themselves.
void set_clock_figures(ProfileReport& report, const std::vector<Profile>& runs) {
  Profile all;
  for (const Profile& run : runs) all.add(run);
  uint64_t calls = 0, calm_nanoseconds = 0;
  for (int i = 0; i < kStageCount; ++i) {
    const StageCounter stage = all.total(static_cast<Stage>(i));
    calls += stage.calls;
    calm_nanoseconds += stage.calm_nanoseconds;
  }
  report.calm_waves = static_cast<double>(all.calm_waves) / static_cast<double>(all.waves);
  if (all.calm_waves > 0) {
    report.between_stages = 1 - seconds_of(calm_nanoseconds) / seconds_of(all.calm_wave_nanoseconds);
  }
  report.clock_seconds = clock_seconds(all.waves, calls) / static_cast<double>(runs.size());
}

// 1, 2, 3, 4, 6, 8, 12, ... and n.
std::vector<uint32_t> thread_counts(uint32_t n) {
  std::vector<uint32_t> counts;
  for (uint32_t power = 1; power < n; power *= 2) {
    counts.push_back(power);
    if (power > 1 && power / 2 * 3 < n) counts.push_back(power / 2 * 3);
  }
  counts.push_back(n);
  return counts;
}

// The counts take turns, so that a busier minute of the machine is shared by all.
std::vector<ScalingPoint> measure_scaling(const Plan& plan, const MeasureOptions& options) {
  std::vector<ScalingPoint> points;
  for (const uint32_t threads : thread_counts(thread_count(plan.settings))) points.push_back({threads, {}});
  Plan other = plan;
  for (uint32_t i = 0; i < options.repeat; ++i) {
    for (ScalingPoint& point : points) {
      options.show(print("scaling  %u of %u, %u threads", i + 1, options.repeat, point.threads));
      other.settings.threads = point.threads;
      point.seconds.push_back(render(other).stats.seconds);
    }
  }
  return points;
}

}  // namespace

ProfileReport measure(const Plan& plan, const MeasureOptions& options) {
  ProfileReport report;
  options.show("warming up");
  run_once(plan, false);

  std::vector<Profile> profiles;
  std::vector<double> outside;
  for (uint32_t i = 0; i < options.repeat; ++i) {
    options.show(print("profiling  %u of %u", i + 1, options.repeat));
    for (const bool clock : {i % 2 == 0, i % 2 != 0}) {
      Run run = run_once(plan, clock);
      (clock ? report.seconds : report.seconds_unclocked).push_back(run.result.stats.seconds);
      (clock ? report.cpu_seconds : report.cpu_seconds_unclocked).push_back(run.cpu_seconds);
      if (!clock) continue;
      report.threads = std::max(report.threads, run.result.stats.threads);
      outside.push_back(1 - seconds_of(run.result.profile.wave_nanoseconds) /
                                (run.result.stats.threads * run.result.stats.seconds));
      profiles.push_back(std::move(run.result.profile));
    }
  }
  report.cpu = cpu_name();
  report.isa = chosen_isa();
  for (const Decision& d : explain(plan)) report.plan.push_back(one_line(d));
  report.samples = report.camera_rays = profiles[0].samples;
  report.light_paths = profiles[0].light_paths;
  report.bounce_rays = profiles[0].bounce_rays;
  report.shadow_rays = profiles[0].shadow_rays;
  report.bounce_limit = kProfiledBounces;
  for (int i = 0; i < kStageCount; ++i) {
    StageReport stage = report_stage(static_cast<Stage>(i), profiles);
    if (stage.total.calls > 0) report.stages.push_back(std::move(stage));
  }
  set_clock_figures(report, profiles);
  report.outside_waves = median(outside);
  if (options.scaling) report.scaling = measure_scaling(plan, options);
  return report;
}

std::vector<std::vector<LoggedCall>> log_calls(const Plan& plan, uint32_t waves) {
  return render(plan, {}, {.clock = true, .logged_waves = waves}).logs;
}

std::string cpu_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) return line.substr(std::min(line.size(), line.find(':') + 2));
  }
  return "unknown processor";
}

}  // namespace lanewise
