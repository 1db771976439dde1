#include "tools/profile_html.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "tools/profile_table.h"
#include "tools/svg.h"
#include "tools/text.h"

namespace lanewise {
namespace {

constexpr const char* kStyle = R"(
body { font: 15px/1.45 system-ui, sans-serif; color: #222; background: #fff; margin: 0 auto; padding: 12px; max-width: 1240px; }
h1 { font-size: 22px; margin: 4px 0 10px; overflow-wrap: anywhere; }
h2 { font-size: 16px; margin: 0 0 2px; }
p { margin: 0 0 8px; color: #555; font-size: 13px; }
pre { font: 12.5px/1.5 ui-monospace, monospace; background: #f6f6f6; padding: 10px; overflow-x: auto; margin: 0 0 14px; }
pre.summary { white-space: pre-wrap; overflow-wrap: anywhere; }
.charts { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 370px), 1fr)); gap: 26px 24px; margin: 18px 0; }
svg { width: 100%; max-width: 440px; display: block; }
svg text { font: 11px system-ui, sans-serif; fill: #333; }
.legend { position: sticky; top: 0; background: #fff; padding: 4px 0; }
.legend span { display: inline-block; margin-right: 10px; white-space: nowrap; }
.legend i { display: inline-block; width: 11px; height: 11px; border-radius: 6px; margin-right: 4px; }
)";

// From purple over green to yellow (viridis, by its five anchors), not quite to its end.
std::string bounce_colour(size_t bounce, size_t bounces) {
  constexpr double kAnchors[5][3] = {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
  const double at = bounces > 1 ? 3.7 * static_cast<double>(bounce) / static_cast<double>(bounces - 1) : 0;
  const size_t i = static_cast<size_t>(at);
  int rgb[3];
  for (size_t c = 0; c < 3; ++c) {
    rgb[c] = static_cast<int>(std::lround(std::lerp(kAnchors[i][c], kAnchors[i + 1][c], at - static_cast<double>(i))));
  }
  return print("#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
}

std::string legend(const ProfileReport& r) {
  std::string html = "<p class='legend'>bounce: ";
  for (size_t b = 0; b < r.bounces(); ++b) {
    html += "<span><i style='background:" + bounce_colour(b, r.bounces()) + "'></i>" + r.bounce_name(b) + "</span>";
  }
  return html + "</p>\n";
}

std::string figure(const char* title, const std::string& explanation, const std::string& svg) {
  return print("<section><h2>%s</h2>\n<p>%s</p>\n", title, explanation.c_str()) + svg + "</section>\n";
}

// A number for each stage and bounce; negative: none.
using Value = std::function<double(const StageReport&, const StageWork&)>;

// Rows of dots, one a bounce.
std::string dots(const ProfileReport& r, const char* axis_title, double least_max, const Value& value,
                 const std::function<bool(const StageReport&)>& shown) {
  Axis axis{axis_title, least_max};
  std::vector<ChartRow> rows;
  for (const StageReport& stage : r.stages) {
    if (!shown(stage)) continue;
    ChartRow row{.name = stage.name};
    for (size_t b = stage.bounces.size(); b-- > 0;) {  // the first bounces on top
      if (stage.bounces[b].calls == 0) continue;
      const double x = value(stage, stage.bounces[b]);
      axis.max = std::max(axis.max, x);
      row.dots.push_back(
          {x, bounce_colour(b, r.bounces()), stage.name + print(", bounce %s: %.4g", r.bounce_name(b).c_str(), x)});
    }
    rows.push_back(row);
  }
  return row_chart(axis, rows);
}

bool every(const StageReport&) { return true; }

std::string time_by_stage(const ProfileReport& r) {
  Axis axis{"ns of thread time a sample", 0};
  std::vector<ChartRow> rows;
  const double per_sample = 1e9 / static_cast<double>(std::max<uint64_t>(r.samples, 1));
  for (const StageReport& stage : r.stages) {
    ChartRow row{.name = stage.name};
    for (size_t b = 0; b < stage.bounces.size(); ++b) {
      const double ns = per_sample * stage.bounces[b].seconds;
      row.bars.push_back({ns, bounce_colour(b, r.bounces()),
                          stage.name + print(", bounce %s: %.3g ns a sample, %.1f %%", r.bounce_name(b).c_str(), ns,
                                             100 * r.share(stage.bounces[b].seconds))});
    }
    axis.max = std::max(axis.max, per_sample * stage.total.seconds);
    rows.push_back(row);
  }
  return row_chart(axis, rows);
}

std::string time_by_bounce(const ProfileReport& r) {
  Axis axis{"% of the time", 0};
  std::vector<ChartRow> rows;
  for (size_t b = 0; b < r.bounces(); ++b) {
    const double percent = 100 * r.share(r.bounce_total(b).seconds);
    axis.max = std::max(axis.max, percent);
    ChartRow row{.name = "bounce " + r.bounce_name(b)};
    row.bars.push_back({percent, bounce_colour(b, r.bounces()), print("%.1f %%", percent)});
    rows.push_back(row);
  }
  return row_chart(axis, rows);
}

std::string queue_lengths(const ProfileReport& r) {
  Axis axis{"paths in a call", 1, true};
  std::vector<ChartRow> rows;
  for (const StageReport& stage : r.stages) {
    const auto& l = stage.total.lengths;
    axis.max = std::max(axis.max, static_cast<double>(l[4]));
    ChartRow row{.name = stage.name};
    row.box.assign(l.begin(), l.end());
    row.box_hint = stage.name + print(": %u, quartiles %u, %u, %u, %u", l[0], l[1], l[2], l[3], l[4]);
    rows.push_back(row);
  }
  return row_chart(axis, rows);
}

std::string scaling(const ProfileReport& r) {
  const double most = r.scaling.back().threads;
  std::vector<std::pair<double, double>> points;
  double fastest = most;
  for (const ScalingPoint& point : r.scaling) {
    points.emplace_back(point.threads, speedup(r.scaling, point));
    fastest = std::max(fastest, points.back().second);
  }
  return line_chart({"threads", most, false, true}, {"speedup over one thread", fastest}, points,
                    {{0, 0}, {most, most}});
}

}  // namespace

std::string profile_page(const ProfileReport& r) {
  std::string html =
      "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'>\n"
      "<meta name='viewport' content='width=device-width, initial-scale=1'>\n";
  html += "<title>Profile of " + escape(r.scene) + "</title>\n<style>" + kStyle + "</style></head><body>\n";
  html += "<h1>Profile of " + escape(r.scene) + "</h1>\n";
  html += "<pre class='summary'>" + escape(r.command) + "</pre>\n";
  html += "<pre class='summary'>" + escape(profile_summary(r)) + "</pre>\n" + legend(r) + "<div class='charts'>\n";
  html += figure("Time by stage", "Each stage&#39;s part of a sample, by bounce.", time_by_stage(r));
  html += figure("Time of a path", "In one call of the stage; one dot a bounce.",
                 dots(
                     r, "ns per path", 0, [](const auto&, const StageWork& w) { return w.ns_per_path(); }, every));
  html +=
      figure("Live lanes", "Of the vector lanes that the stage ran, those with a living path.",
             dots(
                 r, "% of lanes", 100, [](const auto&, const StageWork& w) { return 100 * w.live_lanes(); }, every));
  html += figure("Queue lengths", "Least, quartiles and most paths in a call, over all bounces.", queue_lengths(r));
  html += figure("Bandwidth", "Fields of paths read and written, of one thread; without the scene&#39;s data.",
                 dots(
                     r, "GB/s", 0, [](const auto&, const StageWork& w) { return 1e-9 * w.bytes_per_second(); }, every));
  html += figure("Time by bounce", "Of all stages. Bounce 0 holds what runs once a wave, too.", time_by_bounce(r));
  const auto traces = [](const StageReport& stage) { return stage.traces(); };
  if (std::any_of(r.stages.begin(), r.stages.end(), traces)) {
    html += figure("Rays", "Traced in a second by one thread, in the stages that trace; one dot a bounce.",
                   dots(
                       r, "million rays/s", 0,
                       [](const auto&, const StageWork& w) { return 1e-6 * w.rays_per_second(); }, traces));
  }
  if (r.scaling.size() > 1) html += figure("Threads", "Dashed: what would be ideal.", scaling(r));
  html +=
      "</div>\n<h2>Tables</h2>\n<pre>" + escape(profile_table(r).substr(profile_summary(r).size() + 1)) + "</pre>\n";
  std::string reasons;
  for (const std::string& reason : r.plan) reasons += reason + "\n";
  if (!reasons.empty()) html += "<h2>Plan</h2>\n<pre class='summary'>" + escape(reasons) + "</pre>\n";
  return html + "</body></html>\n";
}

}  // namespace lanewise
