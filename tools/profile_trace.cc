#include "tools/profile_trace.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/text.h"

namespace lanewise {

std::string trace_json(const std::vector<std::vector<LoggedCall>>& logs, const std::string& command,
                       const std::string& scene) {
  uint64_t begin = UINT64_MAX;
  std::vector<size_t> waves;
  for (const auto& log : logs) {
    for (const LoggedCall& call : log) begin = std::min(begin, call.start);
    waves.push_back(static_cast<size_t>(
        std::count_if(log.begin(), log.end(), [](const LoggedCall& call) { return call.stage == Stage::kCount; })));
  }
  const nlohmann::ordered_json about = {{"command", command}, {"scene", scene}, {"first_waves_of_each_thread", waves}};
  std::string text = "{\"displayTimeUnit\": \"ns\",\n\"otherData\": " +
                     about.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + ",\n\"traceEvents\": [\n";
  text += R"({"name": "process_name", "ph": "M", "pid": 1, "args": {"name": "lanewise"}})";
  for (size_t thread = 0; thread < logs.size(); ++thread) {
    text += print(
        ",\n{\"name\": \"thread_name\", \"ph\": \"M\", \"pid\": 1, \"tid\": %zu, \"args\": {\"name\": \"worker %zu\"}}",
        thread + 1, thread + 1);
    for (const LoggedCall& call : logs[thread]) {
      const bool wave = call.stage == Stage::kCount;
      // Times in microseconds.
      text += print(
          ",\n{\"name\": \"%s\", \"cat\": \"%s\", \"ph\": \"X\", \"pid\": 1, \"tid\": %zu, \"ts\": %.3f, \"dur\": "
          "%.3f, ",
          wave ? "wave" : kStageNames[static_cast<size_t>(call.stage)], wave ? "wave" : "stage", thread + 1,
          1e-3 * static_cast<double>(call.start - begin), 1e-3 * static_cast<double>(call.nanoseconds));
      text += wave ? print("\"args\": {\"paths\": %u}}", call.paths)
                   : print("\"args\": {\"bounce\": %u, \"paths\": %u}}", call.bounce, call.paths);
    }
  }
  return text + "\n]}\n";
}

}  // namespace lanewise
