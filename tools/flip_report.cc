#include "tools/flip_report.h"

#include <algorithm>

#include "core/image_io.h"
#include "tools/colour_map.h"
#include "tools/text.h"

namespace lanewise {

FlipReport flip_report(const Image& test, const Image& reference, bool high_range, double pixels_per_degree) {
  FlipReport report{pixels_per_degree};
  if (high_range) {
    report.exposures = flip_exposures(reference);
    report.errors = flip_hdr(test, reference, *report.exposures, pixels_per_degree);
  } else {
    report.errors = flip_ldr(test, reference, pixels_per_degree);
  }
  report.summary = summarize_flip(report.errors);
  return report;
}

void add_flip(nlohmann::ordered_json& json, const FlipReport& report) {
  const FlipSummary& s = report.summary;
  json["flip"] = s.mean;
  json["flip_min"] = s.min;
  json["flip_max"] = s.max;
  json["flip_weighted_quartiles"] = {s.weighted_quartile1, s.weighted_median, s.weighted_quartile3};
  json["flip_pixels_per_degree"] = report.pixels_per_degree;
  if (report.exposures) {
    json["flip_exposures"] = {
        {"start", report.exposures->start}, {"stop", report.exposures->stop}, {"count", report.exposures->count}};
  }
}

std::string flip_line(const FlipReport& report) {
  const FlipSummary& s = report.summary;
  std::string line = print("flip %.6g   weighted median %.4g (quartiles %.4g, %.4g)   largest %.4g   ", s.mean,
                           s.weighted_median, s.weighted_quartile1, s.weighted_quartile3, s.max);
  if (!report.exposures) return line + "as displayed\n";
  const auto& [start, stop, count] = *report.exposures;
  return line + print("over %u exposures, %+.2f to %+.2f stops\n", count, start, stop);
}

Image flip_map(const std::string& path, const FlipReport& report, uint32_t width, uint32_t height) {
  const bool colours = holds_colours(path);
  Image image(width, height);
  for (size_t i = 0; i < report.errors.size(); ++i) {
    const float error = report.errors[i];
    std::ranges::copy(colours ? magma(error) : std::array{error, error, error}, &image.rgb[3 * i]);
  }
  return image;
}

}  // namespace lanewise
