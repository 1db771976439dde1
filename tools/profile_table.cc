#include "tools/profile_table.h"

#include <algorithm>

#include "tools/text.h"

namespace lanewise {
namespace {

std::string lengths_of(const StageWork& work) {
  std::string text;
  for (const uint32_t length : work.lengths) text += print(" %6u", length);
  return text;
}

constexpr const char* kLengths = "   min     q1 median     q3    max";

std::string stages_table(const ProfileReport& r) {
  std::string text = print("%70s%s\n", "", "paths in a call");
  text += print("%-17s %6s %7s %7s %6s %6s %s %8s %5s %7s\n", "stage", "calls", "paths", "ns/path", "time %", "live %",
                kLengths, "bytes", "GB/s", "Mrays/s");
  for (const StageReport& stage : r.stages) {
    const StageWork& w = stage.total;
    text += print("%-17s %6s %7s %7.2f %6.1f %6.1f%s %8s %5.1f", stage.name.c_str(),
                  short_count(static_cast<double>(w.calls)).c_str(), short_count(static_cast<double>(w.paths)).c_str(),
                  w.ns_per_path(), 100 * r.share(w.seconds), 100 * w.live_lanes(), lengths_of(w).c_str(),
                  short_count(w.bytes).c_str(), 1e-9 * w.bytes_per_second());
    if (stage.traces()) text += print(" %7.1f", 1e-6 * w.rays_per_second());
    text += "\n";
  }
  return text +
         "bytes: the fields of a path that the stage reads and writes, 4 bytes each, of every lane; without the "
         "scene's.\n"
         "GB/s and Mrays/s: of one thread. Quartiles of the paths in a call are right to a sixteenth.\n";
}

std::string bounces_table(const ProfileReport& r) {
  std::string text =
      print("%-17s %6s %7s %7s %6s %6s %s\n", "bounce", "calls", "paths", "ns/path", "time %", "live %", kLengths);
  for (size_t b = 0; b < r.bounces(); ++b) {
    const StageWork all = r.bounce_total(b);
    StageWork traced;
    for (const StageReport& stage : r.stages) {
      if (stage.name == "intersect" && b < stage.bounces.size()) traced = stage.bounces[b];
    }
    const double paths = static_cast<double>(traced.paths);
    text += print("%-17s %6s %7s %7.1f %6.1f %6.1f%s\n", r.bounce_name(b).c_str(),
                  short_count(static_cast<double>(all.calls)).c_str(), short_count(paths).c_str(),
                  paths > 0 ? 1e9 * all.seconds / paths : 0, 100 * r.share(all.seconds), 100 * all.live_lanes(),
                  lengths_of(all).c_str());
  }
  return text + "Of all stages; paths: those that intersect gets. Bounce 0 also holds what runs once a wave.\n";
}

std::string matrix(const ProfileReport& r) {
  std::string text = print("%-17s", "ns/path at bounce");
  for (size_t b = 0; b < r.bounces(); ++b) text += print(" %5s", r.bounce_name(b).c_str());
  text += "\n";
  for (const StageReport& stage : r.stages) {
    text += print("%-17s", stage.name.c_str());
    for (const StageWork& work : stage.bounces) {
      const double ns = work.ns_per_path();
      text += work.calls > 0 ? print(" %5.*f", ns < 99.95 ? 1 : 0, ns) : print(" %5s", "");
    }
    text.erase(text.find_last_not_of(' ') + 1);
    text += "\n";
  }
  return text;
}

std::string scaling_table(const ProfileReport& r) {
  std::string text = print("%-17s %9s %9s %11s\n", "threads", "seconds", "speedup", "efficiency");
  for (const ScalingPoint& point : r.scaling) {
    const double times = speedup(r.scaling, point);
    text += print("%-17u %9.3f %8.2fx %9.1f %%\n", point.threads, median(point.seconds), times,
                  100 * times / point.threads);
  }
  return text;
}

}  // namespace

std::string profile_summary(const ProfileReport& r) {
  const auto [fastest, slowest] = std::minmax_element(r.seconds.begin(), r.seconds.end());
  const double seconds = median(r.seconds), samples = static_cast<double>(r.samples);
  const double in_stages = 1e9 * r.stage_seconds() / std::max(samples, 1.0);
  const auto [low, middle, high] = r.overhead_by_turns();
  std::string text = print("%s: %s samples, %s rays\n", r.scene.c_str(), short_count(samples).c_str(),
                           short_count(static_cast<double>(r.rays())).c_str());
  text += print("%s, %s, %u thread%s\n", r.cpu.c_str(), r.isa.c_str(), r.threads, r.threads == 1 ? "" : "s");
  text += print("%zu run%s: median %.3f s (%.3f to %.3f), %s rays/s; %.1f %% of the thread time outside of waves\n",
                r.seconds.size(), r.seconds.size() == 1 ? "" : "s", seconds, *fastest, *slowest,
                short_count(static_cast<double>(r.rays()) / std::max(seconds, 1e-9)).c_str(), 100 * r.outside_waves);
  text += print(
      "a sample takes %.1f ns in stages and %.1f ns between (in calm waves, whose thread never waited: %.1f %%)\n",
      in_stages, in_stages * r.between_stages / (1 - r.between_stages), 100 * r.calm_waves);
  text += print(
      "profiling costs %.2f %% by the number of calls; %.1f %% (quartiles %.1f, %.1f) in turns with renders without\n",
      100 * r.overhead_by_count(), 100 * middle, 100 * low, 100 * high);
  return text;
}

std::string profile_table(const ProfileReport& r) {
  std::string text = profile_summary(r) + "\n" + stages_table(r) + "\n" + bounces_table(r) + "\n" + matrix(r);
  if (!r.scaling.empty()) text += "\n" + scaling_table(r);
  return text;
}

}  // namespace lanewise
