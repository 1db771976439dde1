// Renders a plan again and again, and reports what was counted and how long it took.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/plan.h"
#include "core/profiler.h"
#include "tools/profile_report.h"

namespace lanewise {

struct MeasureOptions {
  uint32_t repeat = 5;                           // profiled renders, each beside one without the clock
  bool scaling = true;                           // also renders with 1, 2, .. threads
  std::function<void(const std::string&)> show;  // told what goes on
};

// Fills in everything but command, version, scene and settings. Threads, wave and samples are those of plan.settings.
ProfileReport measure(const Plan& plan, const MeasureOptions& options);

// The calls of the first `waves` waves of each thread, in one further render.
std::vector<std::vector<LoggedCall>> log_calls(const Plan& plan, uint32_t waves);

// The name that the processor gives itself.
std::string cpu_name();

}  // namespace lanewise
