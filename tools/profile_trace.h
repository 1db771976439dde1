// The calls of stages in time, for a viewer: Perfetto (ui.perfetto.dev), chrome://tracing.
#pragma once

#include <string>
#include <vector>

#include "core/profiler.h"

namespace lanewise {

// Chrome's trace event format: one complete event for each wave and within it for each call of a stage, with bounce and paths;
// one row a thread. Time 0 is the first call's. "otherData" tells command and scene, and of how many waves of each thread these
// are.
std::string trace_json(const std::vector<std::vector<LoggedCall>>& logs, const std::string& command,
                       const std::string& scene);

}  // namespace lanewise
