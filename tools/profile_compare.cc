#include "tools/profile_compare.h"

#include <algorithm>
#include <cmath>

#include "core/run_statistics.h"
#include "tools/text.h"

namespace lanewise {
namespace {

constexpr double kAlarms = 0.01;  // false ones, of all comparisons of equals
constexpr double kLeast = 0.02;   // change of the median

bool is_significant(const std::vector<double>& before, const std::vector<double>& now) {
  return std::fabs(median(now) / median(before) - 1) > kLeast && rank_test(before, now) < kAlarms;
}

std::string noise_of(const std::vector<double>& values) {
  const double middle = median(values);
  return middle > 0 ? print("%.1f", 100 * robust_deviation(values) / middle) : "";
}

std::string row(const std::string& name, double unit, const std::vector<double>& before,
                const std::vector<double>& now) {
  const double ratio = median(before) > 0 ? median(now) / median(before) : 0;
  std::string text = print("%-17s %9.2f %6s %9.2f %6s %8.3f", name.c_str(), unit * median(before),
                           noise_of(before).c_str(), unit * median(now), noise_of(now).c_str(), ratio);
  if (is_significant(before, now)) text += ratio < 1 ? "  faster" : "  SLOWER";
  return text + "\n";
}

std::vector<double> ns_a_sample(const ProfileReport& r) {
  std::vector<double> ns;
  for (const double seconds : r.cpu_seconds)
    ns.push_back(1e9 * seconds / static_cast<double>(std::max<uint64_t>(r.samples, 1)));
  return ns;
}

std::string differences(const ProfileReport& before, const ProfileReport& now) {
  std::string text;
  const auto say = [&](const std::string& what, const std::string& a, const std::string& b) {
    if (a != b) text += print("%s differs: %s, now %s\n", what.c_str(), a.c_str(), b.c_str());
  };
  say("scene", before.scene, now.scene);
  say("processor", before.cpu, now.cpu);
  say("instruction set", before.isa, now.isa);
  say("number of threads", std::to_string(before.threads), std::to_string(now.threads));
  const auto value = [](const ProfileReport& r, const std::string& flag) {
    for (const auto& [name, given] : r.settings) {
      if (name == flag) return given.empty() ? std::string("off") : given;
    }
    return std::string("unknown");
  };
  for (const auto& [flag, given] : now.settings) say(flag, value(before, flag), value(now, flag));
  for (const auto& [flag, given] : before.settings) {
    if (value(now, flag) == "unknown") say(flag, value(before, flag), "unknown");
  }
  if (text.empty() && before.samples != now.samples) {
    say("number of samples", std::to_string(before.samples), std::to_string(now.samples));
  }
  return text;
}

const StageReport* find(const ProfileReport& r, const std::string& name) {
  for (const StageReport& stage : r.stages) {
    if (stage.name == name) return &stage;
  }
  return nullptr;
}

}  // namespace

std::string compare_profiles(const std::string& old_path, const ProfileReport& before, const ProfileReport& now) {
  std::string text = "compared with " + old_path + ", made by: " + before.command + "\n" + differences(before, now);
  text += print("%-17s %9s %6s %9s %6s %8s\n", "ns/path", "old", "+- %", "new", "+- %", "new/old");
  int significant = is_significant(ns_a_sample(before), ns_a_sample(now));
  std::vector<double> ratios;
  for (const StageReport& stage : now.stages) {
    const StageReport* old_stage = find(before, stage.name);
    if (!old_stage) {
      text += print("%-17s %9s %6s %9.2f\n", stage.name.c_str(), "-", "", median(stage.run_ns));
      continue;
    }
    text += row(stage.name, 1, old_stage->run_ns, stage.run_ns);
    significant += is_significant(old_stage->run_ns, stage.run_ns);
  }
  for (const StageReport& stage : before.stages) {
    if (!find(now, stage.name))
      text += print("%-17s %9.2f %6s %9s\n", stage.name.c_str(), median(stage.run_ns), "", "-");
  }
  text += row("a sample, in all", 1, ns_a_sample(before), ns_a_sample(now));
  if (std::min(before.seconds.size(), now.seconds.size()) < 5) {
    return text + "Too few runs to tell a change from noise: --repeat 5 or more, on both sides.\n";
  }
  if (significant == 0) return text + "No change beyond the noise.\n";
  return text + print("%d beyond the noise: medians differ by more than %g %%, and the rank test gives p < %g.\n",
                      significant, 100 * kLeast, kAlarms);
}

}  // namespace lanewise
