#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/image_compare.h"
#include "core/image_io.h"
#include "core/types.h"
#include "tools/commands.h"
#include "tools/flags.h"
#include "tools/flip_report.h"
#include "tools/output_files.h"

namespace lanewise {
namespace {

enum class Metric : uint8_t { kMse, kFlip, kFlipLdr };

struct CompareOptions {
  std::string a;
  std::string b;
  Metric metric = Metric::kMse;
  double pixels_per_degree = kFlipPixelsPerDegree;
  std::string map;
  bool json = false;
};

struct Comparison {
  ImageComparison errors;
  std::optional<FlipReport> flip{};
};

Comparison compare(const CompareOptions& o, const Image& a, const Image& b) try {
  Comparison result{compare_images(a, b)};
  if (o.metric != Metric::kMse) {
    const bool high_range = o.metric == Metric::kFlip && !holds_colours(o.a) && !holds_colours(o.b);
    result.flip = flip_report(a, b, high_range, o.pixels_per_degree);
  }
  return result;
} catch (const Error& e) {
  throw Error(o.a + " and " + o.b + ": " + e.what());
}

std::string json_text(const CompareOptions& o, const Image& image, const Comparison& comparison) {
  const ImageComparison& c = comparison.errors;
  // JSON has no infinity: a relative difference from black becomes null.
  nlohmann::ordered_json json = {
      {"a", o.a},
      {"b", o.b},
      {"width", image.width},
      {"height", image.height},
      {"mean_a", c.mean_a},
      {"mean_b", c.mean_b},
      {"relative_difference", c.relative_difference},
      {"mse", c.mse},
      {"mrse", c.mrse},
      {"differing", c.differing},
  };
  if (comparison.flip) add_flip(json, *comparison.flip);
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string table(const Comparison& comparison) {
  const ImageComparison& c = comparison.errors;
  char line[160];
  std::string text = "          mean A        mean B   A against B\n";
  for (size_t i = 0; i < 3; ++i) {
    std::snprintf(line, sizeof line, "%c  %13.6g %13.6g %+12.4f %%\n", "RGB"[i], c.mean_a[i], c.mean_b[i],
                  100 * c.relative_difference[i]);
    text += line;
  }
  std::snprintf(line, sizeof line, "mse %.6g   mrse %.6g   differing %.4g %% of the pixels\n", c.mse, c.mrse,
                100 * c.differing);
  text += line;
  return comparison.flip ? text + flip_line(*comparison.flip) : text;
}

void check_map(const CompareOptions& o) {
  if (o.map.empty()) return;
  if (o.metric == Metric::kMse) throw UsageError("--map: only with --metric flip or flip-ldr");
  check_image_extension(o.map);
  OutputFiles files;
  files.keep(o.a);
  files.keep(o.b);
  files.add("--map", o.map);
  check_image_writable(o.map);
}

void run_compare(const CompareOptions& o) {
  check_map(o);
  const Image a = read_image(o.a);
  const Image b = read_image(o.b);
  const Comparison comparison = compare(o, a, b);
  if (!o.map.empty()) write_image(o.map, flip_map(o.map, *comparison.flip, a.width, a.height));
  std::cout << (o.json ? json_text(o, a, comparison) : table(comparison));
}

}  // namespace

void add_compare_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("compare", "Compare two pictures, the second being the reference");
  command->group("Commands");
  command->footer(
      "Pictures are compared in linear radiance (.png is decoded from sRGB).\n"
      "mse is the mean of (A - B)^2, mrse that of (A - B)^2 / (B + 0.01)^2; exits with 0 whatever they are.\n"
      "FLIP (Andersson et al. 2020, 2021) is what differences look like, in [0, 1]: for pictures of floats the "
      "largest\n"
      "over exposures, for .png and with flip-ldr that of colours as displayed, radiance clipped to [0, 1].");
  const auto options = std::make_shared<CompareOptions>();
  command->add_option("A", options->a, "Picture: .png, .exr, .pfm or .hdr")->required()->type_name("");
  command->add_option("B", options->b, "The reference, of the same size: .png, .exr, .pfm or .hdr")
      ->required()
      ->type_name("");
  add_choice<Metric>(*command, "--metric", options->metric,
                     {{"mse", Metric::kMse}, {"flip", Metric::kFlip}, {"flip-ldr", Metric::kFlipLdr}},
                     "Compute FLIP too");
  command
      ->add_option("--map", options->map,
                   "Write FLIP's error of every pixel: magma colours in a .png, floats in an .exr, .pfm or .hdr")
      ->type_name("FILE");
  command->add_option("--ppd", options->pixels_per_degree, "Pixels per degree of the viewer of FLIP")
      ->check(real_number(5, 1000))
      ->type_name("X");
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options] { run_compare(*options); });
}

}  // namespace lanewise
