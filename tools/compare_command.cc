#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/image_compare.h"
#include "core/image_io.h"
#include "core/types.h"
#include "tools/commands.h"

namespace lanewise {
namespace {

struct CompareOptions {
  std::string a;
  std::string b;
  bool json = false;
};

std::string json_text(const CompareOptions& o, const Image& image, const ImageComparison& c) {
  // JSON has no infinity: a relative difference from black becomes null.
  const nlohmann::ordered_json json = {
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
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string table(const ImageComparison& c) {
  char line[160];
  std::string text = "          mean A        mean B   A against B\n";
  for (size_t i = 0; i < 3; ++i) {
    std::snprintf(line, sizeof line, "%c  %13.6g %13.6g %+12.4f %%\n", "RGB"[i], c.mean_a[i], c.mean_b[i],
                  100 * c.relative_difference[i]);
    text += line;
  }
  std::snprintf(line, sizeof line, "mse %.6g   mrse %.6g   differing %.4g %% of the pixels\n", c.mse, c.mrse,
                100 * c.differing);
  return text + line;
}

std::string text_of(const CompareOptions& o, const Image& a, const Image& b) try {
  const ImageComparison comparison = compare_images(a, b);
  return o.json ? json_text(o, a, comparison) : table(comparison);
} catch (const Error& e) {
  throw Error(o.a + " and " + o.b + ": " + e.what());
}

void run_compare(const CompareOptions& o) {
  const Image a = read_image(o.a);
  const Image b = read_image(o.b);
  std::cout << text_of(o, a, b);
}

}  // namespace

void add_compare_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("compare", "Compare two pictures, the second being the reference");
  command->group("Commands");
  command->footer(
      "Pictures are compared in linear radiance (.png is decoded from sRGB).\n"
      "mse is the mean of (A - B)^2, mrse that of (A - B)^2 / (B + 0.01)^2; exits with 0 whatever they are.");
  const auto options = std::make_shared<CompareOptions>();
  command->add_option("A", options->a, "Picture: .png, .exr, .pfm or .hdr")->required()->type_name("");
  command->add_option("B", options->b, "The reference, of the same size")->required()->type_name("");
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options] { run_compare(*options); });
}

}  // namespace lanewise
