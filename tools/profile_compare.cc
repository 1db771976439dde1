#include "tools/profile_compare.h"

#include <algorithm>
#include <cmath>

#include "core/run_statistics.h"
#include "tools/text.h"

namespace lanewise {
namespace {

constexpr double kAlarms = 0.01;  // false ones, of all comparisons of equals

// The least change of a median that is marked, and for stages with less than the share kSmall of the time.
constexpr double kLeast = 0.03, kLeastOfSmall = 0.10, kSmall = 0.01;
constexpr double kOfBusy = 0.3;  // is added for each share of the waves that were not calm

std::string noise_of(const std::vector<double>& values) {
  const double middle = median(values);
  return middle > 0 ? print("%.1f", 100 * robust_deviation(values) / middle) : "";
}

// One row: ns of each run, and by how much their medians must differ.
struct Change {
  std::string name;
  std::vector<double> before, now;
  double least = kLeast;

  double ratio() const { return median(before) > 0 ? median(now) / median(before) : 0; }
  bool is_significant() const {
    return median(before) > 0 && std::fabs(ratio() - 1) > least && rank_test(before, now) < kAlarms;
  }
  std::string row() const {
    std::string text = print("%-17s %9.2f %6s %9.2f %6s %8.3f", name.c_str(), median(before), noise_of(before).c_str(),
                             median(now), noise_of(now).c_str(), ratio());
    if (is_significant()) text += ratio() < 1 ? "  faster" : "  SLOWER";
    return text + "\n";
  }
};

// CPU time of a sample, in each run.
std::vector<double> cpu_ns(const ProfileReport& r) {
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
  const double busy = kOfBusy * (1 - std::min(before.calm_waves, now.calm_waves));
  std::vector<Change> changes;
  for (const StageReport& stage : now.stages) {
    const StageReport* old = find(before, stage.name);
    if (!old) continue;
    const double least = (now.share(stage.total.seconds) < kSmall ? kLeastOfSmall : kLeast) + busy;
    changes.push_back({stage.name, old->run_ns, stage.run_ns, least});
  }
  changes.push_back({"CPU, ns/sample", cpu_ns(before), cpu_ns(now), kLeast + busy});
  int significant = 0;
  for (const Change& change : changes) {
    text += change.row();
    significant += change.is_significant();
  }
  for (const StageReport& stage : now.stages) {
    if (!find(before, stage.name)) text += stage.name + ": only now\n";
  }
  for (const StageReport& stage : before.stages) {
    if (!find(now, stage.name)) text += stage.name + ": no more\n";
  }
  if (std::min(before.seconds.size(), now.seconds.size()) < 5) {
    return text + "Too few runs to tell a change from noise: --repeat 5 or more, on both sides.\n";
  }
  if (significant == 0) return text + "No change beyond the noise.\n";
  return text +
         print(
             "%d beyond the noise: p < %g by the rank test, and more than %.1f %% (%.1f %% below %g %% of the time).\n",
             significant, kAlarms, 100 * (kLeast + busy), 100 * (kLeastOfSmall + busy), 100 * kSmall);
}

}  // namespace lanewise
