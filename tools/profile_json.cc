#include "tools/profile_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/file.h"
#include "core/types.h"

namespace lanewise {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "lanewise profile";
constexpr int kFormatVersion = 1;
constexpr uint64_t kMostBytes = uint64_t{1} << 26;
constexpr size_t kMostRuns = 1000;

Json json_of(const ProfileReport& report, const StageReport& stage, const StageWork& work) {
  Json json = {{"calls", work.calls},
               {"paths", work.paths},
               {"lanes", work.lanes},
               {"live_lanes", work.live_lanes()},
               {"paths_per_call", work.lengths},
               {"seconds", work.seconds},
               {"share", report.share(work.seconds)},
               {"ns_per_path", work.ns_per_path()},
               {"bytes", work.bytes},
               {"bytes_per_second", work.bytes_per_second()}};
  if (stage.traces()) {
    json["rays"] = work.rays;
    json["rays_per_second"] = work.rays_per_second();
  }
  return json;
}

Json json_of(const ProfileReport& report, const StageReport& stage) {
  Json json = {{"name", stage.name}, {"words_read", stage.read_words}, {"words_written", stage.written_words}};
  json.update(json_of(report, stage, stage.total));
  json["ns_per_path_runs"] = stage.run_ns;
  json["bounces"] = Json::array();
  for (size_t b = 0; b < stage.bounces.size(); ++b) {
    if (stage.bounces[b].calls == 0) continue;
    Json bounce = {{"bounce", b}};
    bounce.update(json_of(report, stage, stage.bounces[b]));
    json["bounces"].push_back(bounce);
  }
  return json;
}

Json json_of(const std::vector<ScalingPoint>& scaling, const ScalingPoint& point) {
  const double times = speedup(scaling, point);
  return {{"threads", point.threads},
          {"seconds", point.seconds},
          {"median_seconds", median(point.seconds)},
          {"speedup", times},
          {"efficiency", times / point.threads}};
}

StageWork work_from(const Json& json) {
  StageWork work{json.at("calls"), json.at("paths"), json.at("lanes"), json.value("rays", uint64_t{0})};
  work.lengths = json.at("paths_per_call");
  work.bytes = json.at("bytes");
  work.seconds = json.at("seconds");
  return work;
}

// Times, none of which may be negative or missing.
std::vector<double> times_from(const Json& json, size_t count) {
  const auto times = json.get<std::vector<double>>();
  if (times.size() != count || times.empty()) throw Error("not as many times as runs");
  for (const double time : times) {
    if (!(time >= 0) || !std::isfinite(time)) throw Error("a time that is none");
  }
  return times;
}

StageReport stage_from(const Json& json, size_t runs) {
  StageReport stage;
  stage.name = json.at("name");
  stage.read_words = json.at("words_read");
  stage.written_words = json.at("words_written");
  stage.total = work_from(json);
  stage.run_ns = times_from(json.at("ns_per_path_runs"), runs);
  for (const Json& bounce : json.at("bounces")) {
    const size_t b = bounce.at("bounce");
    if (b >= 64) throw Error("a bounce of a number too large");
    if (stage.bounces.size() <= b) stage.bounces.resize(b + 1);
    stage.bounces[b] = work_from(bounce);
  }
  return stage;
}

ProfileReport report_from(const Json& json) {
  if (!json.is_object() || json.value("format", "") != kFormat) throw Error("not a profile");
  if (json.at("format_version") != kFormatVersion) throw Error("a profile of another version of lanewise");
  ProfileReport r;
  r.command = json.at("command");
  r.version = json.at("version");
  r.scene = json.at("scene");
  r.cpu = json.at("cpu");
  r.isa = json.at("isa");
  r.threads = json.at("threads");
  for (const auto& [flag, value] : json.at("settings").items()) r.settings.emplace_back(flag, value);
  r.plan = json.at("plan");
  r.samples = json.at("samples");
  r.camera_rays = json.at("rays").at("camera");
  r.light_paths = json.at("rays").value("light", uint64_t{0});
  r.bounce_rays = json.at("rays").at("bounce");
  r.shadow_rays = json.at("rays").at("shadow");
  r.bounce_limit = json.at("bounce_limit");
  const size_t runs = json.at("seconds").size();
  if (runs > kMostRuns) throw Error("too many runs");
  r.seconds = times_from(json.at("seconds"), runs);
  r.seconds_unclocked = times_from(json.at("seconds_unclocked"), runs);
  r.cpu_seconds = times_from(json.at("cpu_seconds"), runs);
  r.cpu_seconds_unclocked = times_from(json.at("cpu_seconds_unclocked"), runs);
  r.calm_waves = json.at("calm_waves");
  r.between_stages = json.at("between_stages");
  r.outside_waves = json.at("outside_waves");
  r.clock_seconds = json.at("clock_seconds");
  for (const Json& stage : json.at("stages")) r.stages.push_back(stage_from(stage, runs));
  for (const Json& point : json.at("scaling")) {
    r.scaling.push_back({point.at("threads"), times_from(point.at("seconds"), point.at("seconds").size())});
  }
  return r;
}

}  // namespace

std::string profile_json(const ProfileReport& r) {
  const double seconds = median(r.seconds);
  const auto [low, middle, high] = r.overhead_by_turns();
  Json json = {
      {"format", kFormat},
      {"format_version", kFormatVersion},
      {"command", r.command},
      {"version", r.version},
      {"scene", r.scene},
      {"cpu", r.cpu},
      {"isa", r.isa},
      {"threads", r.threads},
      {"settings", Json::object()},
      {"plan", r.plan},
      {"samples", r.samples},
      {"rays",
       {{"camera", r.camera_rays}, {"light", r.light_paths}, {"bounce", r.bounce_rays}, {"shadow", r.shadow_rays}}},
      {"bounce_limit", r.bounce_limit},
      {"median_seconds", seconds},
      {"rays_per_second", seconds > 0 ? static_cast<double>(r.rays()) / seconds : 0},
      {"seconds", r.seconds},
      {"seconds_unclocked", r.seconds_unclocked},
      {"cpu_seconds", r.cpu_seconds},
      {"cpu_seconds_unclocked", r.cpu_seconds_unclocked},
      {"stage_seconds", r.stage_seconds()},
      {"calm_waves", r.calm_waves},
      {"between_stages", r.between_stages},
      {"outside_waves", r.outside_waves},
      {"clock_seconds", r.clock_seconds},
      {"overhead", {{"by_count", r.overhead_by_count()}, {"by_turns", {low, middle, high}}}},
      {"stages", Json::array()},
      {"scaling", Json::array()}};
  for (const auto& [flag, value] : r.settings) json["settings"][flag] = value;
  for (const StageReport& stage : r.stages) json["stages"].push_back(json_of(r, stage));
  for (const ScalingPoint& point : r.scaling) json["scaling"].push_back(json_of(r.scaling, point));
  // File names may hold any bytes; what is not UTF-8 is replaced.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

ProfileReport read_profile(const std::string& path) try {
  return report_from(Json::parse(read_file(path, kMostBytes)));
} catch (const nlohmann::json::parse_error&) {
  throw Error(path + ": not a profile: no JSON");
} catch (const nlohmann::json::exception& e) {
  throw Error(path +
              ": not a whole profile: " + std::string(e.what()).substr(std::string_view(e.what()).find("] ") + 2));
} catch (const Error& e) {
  throw Error(path + ": " + e.what());
}

}  // namespace lanewise
