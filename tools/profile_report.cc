#include "tools/profile_report.h"

#include <algorithm>

namespace lanewise {

StageWork ProfileReport::bounce_total(size_t bounce) const {
  StageWork sum;
  for (const StageReport& stage : stages) {
    if (bounce >= stage.bounces.size()) continue;
    sum.add(stage.bounces[bounce]);
    if (stage.name == "intersect") sum.lengths = stage.bounces[bounce].lengths;
  }
  return sum;
}

double ProfileReport::overhead_by_count() const { return share(clock_seconds); }

std::array<double, 3> ProfileReport::overhead_by_turns() const {
  std::vector<double> shares;
  for (size_t i = 0; i < std::min(cpu_seconds.size(), cpu_seconds_unclocked.size()); ++i) {
    if (cpu_seconds_unclocked[i] > 0) shares.push_back(cpu_seconds[i] / cpu_seconds_unclocked[i] - 1);
  }
  if (shares.empty()) return {};
  std::sort(shares.begin(), shares.end());
  const size_t last = shares.size() - 1;
  return {shares[last / 4], median(shares), shares[last - last / 4]};
}

double speedup(const std::vector<ScalingPoint>& scaling, const ScalingPoint& point) {
  const double now = median(point.seconds);
  return !scaling.empty() && now > 0 ? median(scaling.front().seconds) / now : 0;
}

}  // namespace lanewise
