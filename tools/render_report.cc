#include "tools/render_report.h"

#include <sys/resource.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/plan_report.h"
#include "tools/text.h"
#include "tools/version.h"

namespace lanewise {
namespace {

uint64_t total_rays(const RenderStats& s) { return s.camera_rays + s.light_paths + s.bounce_rays + s.shadow_rays; }

double rays_per_second(const RenderReport& r) {
  return r.seconds.render > 0 ? static_cast<double>(total_rays(r.stats)) / r.seconds.render : 0;
}

uint64_t peak_rss_bytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}

// Three digits, and never "100" for less.
std::string short_number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x > 99.9 && x < 100 ? 99.9 : x);
  return text;
}

std::string short_seconds(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, seconds < 10 ? "%.2f s" : "%.1f s", seconds);
  return text;
}

std::string count_of(uint64_t n, const char* what) { return std::to_string(n) + " " + what + (n == 1 ? "" : "s"); }

}  // namespace

std::string stats_json(const RenderReport& r) {
  const Settings& settings = r.options.settings;
  const RenderStats& s = r.stats;
  nlohmann::ordered_json json = {
      {"scene", r.options.scene},
      {"command", r.command_line},
      {"version", kVersion},
      {"width", settings.window().width},
      {"height", settings.window().height},
      {"spp", settings.spp},
      {"max_depth", settings.max_depth},
      {"seed", settings.seed},
      {"threads", s.threads},
      {"isa", r.isa},
      {"wave", settings.wave},
      {"seconds",
       {{"load", r.seconds.load}, {"plan", r.seconds.plan}, {"render", r.seconds.render}, {"write", r.seconds.write}}},
      {"samples", s.samples},
      {"rays",
       {{"camera", s.camera_rays},
        {"light", s.light_paths},
        {"bounce", s.bounce_rays},
        {"shadow", s.shadow_rays},
        {"total", total_rays(s)}}},
      {"rays_per_second", rays_per_second(r)},
      {"peak_rss_bytes", peak_rss_bytes()},
      {"invalid_samples", s.invalid_samples},
      {"samples_per_pixel", s.samples_per_pixel},
      {"converged", s.converged},
      {"paths_by_length", s.paths_by_length},
  };
  if (settings.only_bounce) json["only_bounce"] = *settings.only_bounce;
  if (settings.seconds > 0) json["time_budget"] = settings.seconds;
  if (s.error) json["estimated_mrse"] = {{"value", s.error->mrse}, {"low", s.error->low}, {"high", s.error->high}};
  for (const RankStats& rank : s.ranks) {
    json["ranks"].push_back({{"rank", rank.rank},
                             {"threads", rank.threads},
                             {"samples", rank.samples},
                             {"bytes_sent", rank.bytes_sent},
                             {"bytes_received", rank.bytes_received}});
  }
  json["plan"] = decisions_json(r.plan);
  json["stages"] = nlohmann::ordered_json::array();
  for (const StageStats& stage : s.stages) {
    json["stages"].push_back({{"name", stage.name},
                              {"calls", stage.calls},
                              {"paths", stage.paths},
                              {"seconds", stage.seconds},
                              {"lanes_live", stage.lanes_live}});
  }
  // File names may hold any bytes; what is not UTF-8 is replaced.
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string samples_per_pixel(const RenderOptions& o, const RenderStats& stats) {
  const Settings& settings = o.settings;
  const bool fixed = settings.adaptive_batch == 0 && settings.noise == 0 && settings.seconds == 0;
  if (fixed && settings.allocation == Allocation::kEven) return std::to_string(settings.spp);
  char mean[32];
  std::snprintf(mean, sizeof mean, "%.1f", stats.samples_per_pixel);
  return mean;
}

std::string summary(const RenderReport& r) {
  const Settings& settings = r.options.settings;
  const RenderStats& s = r.stats;
  std::string text = r.options.scene + " -> " + r.options.output + "\n";
  text += std::to_string(settings.window().width) + " x " + std::to_string(settings.window().height) + ", ";
  const bool adaptive = settings.adaptive_batch > 0 || settings.noise > 0;
  // Without -s, --time has no limit worth telling.
  const bool limited = settings.seconds == 0 || settings.spp < kMaxSpp;
  const bool counted = adaptive || settings.seconds > 0;
  const bool even = settings.allocation == Allocation::kEven;
  if (counted) text += samples_per_pixel(r.options, s) + (limited ? " of at most " : " samples");
  if (limited && (counted || even)) text += count_of(settings.spp, "sample");
  if (!counted && !even) text += samples_per_pixel(r.options, s) + " samples";
  text += std::string(" per pixel") + (even ? "" : " by its noise") + ", " +
          std::string(settings.only_bounce ? "only bounce " : "depth ") + std::to_string(settings.max_depth) + ", " +
          count_of(s.threads, "thread") + (s.ranks.empty() ? "" : " of " + count_of(s.ranks.size(), "rank")) + ", " +
          r.isa + "\n";
  if (adaptive) {
    const std::string aim = settings.noise > 0
                                ? "standard error of " + short_number(100 * settings.noise) + " %"
                                : "tolerance of " + short_number(100 * settings.adaptive_tolerance) + " %";
    text += aim + " reached in " + short_number(100 * s.converged) + " % of the pixels\n";
  }
  if (s.error) {
    text += "estimated error: MRSE " + short_number(s.error->mrse) + " (95%: " + short_number(s.error->low) + " to " +
            short_number(s.error->high) + ")\n";
  }
  text += "load " + short_seconds(r.seconds.load) + ", plan " + short_seconds(r.seconds.plan) + ", render " +
          short_seconds(r.seconds.render) + ", write " + short_seconds(r.seconds.write) + "\n";
  text += short_count(static_cast<double>(s.samples)) + " samples, " + short_count(static_cast<double>(total_rays(s))) +
          " rays, " + short_count(rays_per_second(r)) + " rays/s\n";
  return text;
}

}  // namespace lanewise
