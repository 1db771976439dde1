// What `lanewise profile` measures: the one form that the table, the page, the JSON file and the comparison are made from.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/run_statistics.h"

namespace lanewise {

// A stage's work, at one bounce or over all, in one render. Counts are the same in every run.
struct StageWork {
  uint64_t calls = 0;
  uint64_t paths = 0;  // living, without padding
  uint64_t lanes = 0;  // run, with padding
  uint64_t rays = 0;
  std::array<uint32_t, 5> lengths{};  // paths per call: least, quartiles, most; quartiles to within a sixteenth
  // That all lanes move, by the model that each moves every field listed once, and the sort of a finished path only what
  // retires. Reads of the scene and the film are not in it.
  double bytes = 0;
  // Thread time: at a bounce the median of the runs, each by the time of a path in calm waves (see StageCounter).
  double seconds = 0;

  double ns_per_path() const { return paths > 0 ? 1e9 * seconds / static_cast<double>(paths) : 0; }
  double live_lanes() const { return lanes > 0 ? static_cast<double>(paths) / static_cast<double>(lanes) : 0; }
  // Of one thread.
  double rays_per_second() const { return seconds > 0 ? static_cast<double>(rays) / seconds : 0; }
  double bytes_per_second() const { return seconds > 0 ? bytes / seconds : 0; }

  void add(const StageWork& other) {
    calls += other.calls;
    paths += other.paths;
    lanes += other.lanes;
    rays += other.rays;
    bytes += other.bytes;
    seconds += other.seconds;
  }
};

struct StageReport {
  std::string name;
  uint32_t read_words = 0;  // fields of a path, 4 bytes each: what kernels.h lists
  uint32_t written_words = 0;
  StageWork total;                 // seconds and bytes: sums over bounces
  std::vector<StageWork> bounces;  // [bounce]; those where the stage did nothing have no calls
  std::vector<double> run_ns;      // ns per path of each run in calm waves, over all bounces

  bool traces() const { return total.rays > 0; }
};

struct ScalingPoint {
  uint32_t threads = 0;
  std::vector<double> seconds;  // wall clock of each run
};

struct ProfileReport {
  std::string command, version, scene, cpu, isa;
  uint32_t threads = 0;                                       // that did some of the work
  std::vector<std::pair<std::string, std::string>> settings;  // flag and value, given or default
  std::vector<std::string> plan;                              // what it chose and why

  uint64_t samples = 0, camera_rays = 0, light_paths = 0, bounce_rays = 0, shadow_rays = 0;
  uint32_t bounce_limit = 0;  // that bounces are told apart up to: the last stands for all that follow

  // Of each run, and of renders without the clock that took turns with them.
  std::vector<double> seconds, seconds_unclocked;          // wall clock
  std::vector<double> cpu_seconds, cpu_seconds_unclocked;  // of all threads
  double calm_waves = 1;                                   // share of all runs' waves
  double between_stages = 0;                               // share of the time of calm waves
  double outside_waves = 0;                                // share of thread time, median of the runs
  double clock_seconds = 0;  // thread time that counting and clocking take of a run, by the number of calls

  std::vector<StageReport> stages;    // those that ran
  std::vector<ScalingPoint> scaling;  // by threads; empty if it was not asked for

  double stage_seconds() const {
    double sum = 0;
    for (const StageReport& stage : stages) sum += stage.total.seconds;
    return sum;
  }
  double share(double seconds_of_stage) const { return stage_seconds() > 0 ? seconds_of_stage / stage_seconds() : 0; }
  uint64_t rays() const { return camera_rays + light_paths + bounce_rays + shadow_rays; }
  size_t bounces() const {
    size_t most = 0;
    for (const StageReport& stage : stages) most = std::max(most, stage.bounces.size());
    return most;
  }
  std::string bounce_name(size_t bounce) const {
    return std::to_string(bounce) + (bounce + 1 == bounce_limit ? "+" : "");
  }
  // Of all stages at a bounce; its lengths are those of intersect, the paths that came.
  StageWork bounce_total(size_t bounce) const;

  // Share by which profiling prolongs a render: from the number of calls, and as the runs have it (CPU time with and without,
  // pair by pair: quartiles).
  double overhead_by_count() const;
  std::array<double, 3> overhead_by_turns() const;
};

// Speed at each point against the first of one thread.
double speedup(const std::vector<ScalingPoint>& scaling, const ScalingPoint& point);

}  // namespace lanewise
