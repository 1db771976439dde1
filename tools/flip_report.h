// FLIP for `lanewise compare`: its errors as figures and as a picture.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/flip.h"

namespace lanewise {

struct FlipReport {
  double pixels_per_degree = 0;
  std::optional<FlipExposures> exposures{};  // only for high dynamic range
  std::vector<float> errors{};               // per pixel
  FlipSummary summary{};
};

// high_range: over exposures, as flip_hdr() has it; otherwise as flip_ldr() does.
FlipReport flip_report(const Image& test, const Image& reference, bool high_range, double pixels_per_degree);

// "flip", the mean, and names that begin so.
void add_flip(nlohmann::ordered_json& json, const FlipReport& report);
// One line.
std::string flip_line(const FlipReport& report);

// For a file that holds colours (.png) those of magma, black for 0 and pale yellow for 1, as in the papers; for one of
// floats the errors themselves, in every channel.
Image flip_map(const std::string& path, const FlipReport& report, uint32_t width, uint32_t height);

}  // namespace lanewise
