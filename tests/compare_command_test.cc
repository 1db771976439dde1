// `lanewise compare --metric flip` from outside. LANEWISE_BINARY names the program.
#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/flip.h"
#include "core/image_io.h"
#include "tests/program.h"
#include "tests/subprocess.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

using nlohmann::json;
using test::nothing_to_test;
using test::ProcessResult;
using test::TemporaryFolder;
using Arguments = std::vector<std::string>;

ProcessResult compare(const TemporaryFolder& folder, Arguments arguments) {
  arguments.insert(arguments.begin(), "compare");
  return test::run_process(test::program(), arguments, folder.path());
}

json compare_to_json(const TemporaryFolder& folder, Arguments arguments) {
  arguments.insert(arguments.end(), {"--json"});
  const ProcessResult result = compare(folder, arguments);
  CAPTURE(result.err);
  REQUIRE(result.exit_code == 0);
  return json::parse(result.out);
}

// A step of light, brighter than displays are, and what is to be told from it.
struct Pair {
  Image test{24, 16}, reference{24, 16};

  Pair() {
    for (size_t i = 0; i < reference.rgb.size(); ++i) {
      reference.rgb[i] = i % 72 < 36 ? 0.25f : 4.0f;
      test.rgb[i] = i % 3 == 0 ? 0.75f * reference.rgb[i] : reference.rgb[i];
    }
  }
  void write(const TemporaryFolder& folder) const {
    for (const char* extension : {".pfm", ".exr", ".png"}) {
      write_image(folder.file(std::string("a") + extension), test);
      write_image(folder.file(std::string("b") + extension), reference);
    }
  }
};

TEST_CASE("compare command: FLIP by the kind of the pictures, beside the other figures") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const Pair pair;
  pair.write(folder);
  const FlipExposures exposures = flip_exposures(pair.reference);
  const double high = summarize_flip(flip_hdr(pair.test, pair.reference, exposures)).mean;
  const double displayed = summarize_flip(flip_ldr(pair.test, pair.reference)).mean;
  REQUIRE(high > 1.05 * displayed);

  const json floats = compare_to_json(folder, {"a.pfm", "b.exr", "--metric", "flip"});
  CHECK(floats["flip"].get<double>() == doctest::Approx(high));
  CHECK(floats["mrse"].get<double>() == compare_to_json(folder, {"a.pfm", "b.exr"})["mrse"].get<double>());
  CHECK(floats["flip_exposures"]["count"] == exposures.count);
  CHECK(floats["flip_exposures"]["stop"].get<double>() == doctest::Approx(exposures.stop));
  CHECK(floats["flip_min"].get<double>() <= floats["flip_weighted_quartiles"][0].get<double>());
  CHECK(floats["flip_max"].get<double>() >= floats["flip_weighted_quartiles"][2].get<double>());

  const json clipped = compare_to_json(folder, {"a.pfm", "b.exr", "--metric", "flip-ldr"});
  CHECK(clipped["flip"].get<double>() == doctest::Approx(displayed));
  CHECK(!clipped.contains("flip_exposures"));
  const json colours = compare_to_json(folder, {"a.png", "b.png", "--metric", "flip"});
  CHECK(colours["flip"].get<double>() == doctest::Approx(displayed).epsilon(0.02));  // 8 bits
  CHECK(!compare_to_json(folder, {"a.pfm", "b.pfm"}).contains("flip"));

  const json far = compare_to_json(folder, {"a.pfm", "b.pfm", "--metric", "flip", "--ppd", "30"});
  CHECK(far["flip_pixels_per_degree"] == 30);
  CHECK(far["flip"] != floats["flip"]);

  const ProcessResult table = compare(folder, {"a.pfm", "b.pfm", "--metric", "flip"});
  CHECK(table.exit_code == 0);
  CHECK(table.out.find("\nflip 0.") != std::string::npos);
  CHECK(table.out.find(" exposures, ") != std::string::npos);
}

TEST_CASE("compare command: FLIP's map, as floats and in magma colours") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const Pair pair;
  pair.write(folder);
  compare_to_json(folder, {"a.pfm", "b.pfm", "--metric", "flip-ldr", "--map", "map.pfm"});
  const std::vector<float> errors = flip_ldr(pair.test, pair.reference);
  const Image map = read_image(folder.file("map.pfm"));
  for (size_t i = 0; i < errors.size(); ++i) CHECK(map.rgb[3 * i] == errors[i]);

  write_image(folder.file("green.pfm"), [] {
    Image image(24, 16);
    for (size_t i = 0; i < image.rgb.size(); i += 3) image.rgb[i + 1] = 1;
    return image;
  }());
  write_image(folder.file("blue.pfm"), [] {
    Image image(24, 16);
    for (size_t i = 0; i < image.rgb.size(); i += 3) image.rgb[i + 2] = 1;
    return image;
  }());
  // The ends of matplotlib's magma: #000004 and #fcfdbf, in steps of 1/255.
  const auto corner = [&](const char* a, const char* b) {
    compare_to_json(folder, {a, b, "--metric", "flip-ldr", "--map", "map.png"});
    return read_image(folder.file("map.png"));
  };
  CHECK(corner("blue.pfm", "blue.pfm").rgb[2] == doctest::Approx(4 / 255.0 / 12.92).epsilon(1e-3));
  CHECK(corner("green.pfm", "blue.pfm").rgb[0] == doctest::Approx(0.9734).epsilon(0.005));
}

TEST_CASE("compare command: wrong flags end with 2, one line and no map") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const Pair pair;
  pair.write(folder);
  write_image(folder.file("small.pfm"), Image(3, 2));
  const auto check_failure = [&](int exit_code, const Arguments& arguments, const std::string& mentions) {
    const ProcessResult result = compare(folder, arguments);
    CAPTURE(result.err);
    CHECK(result.exit_code == exit_code);
    CHECK(std::ranges::count(result.err, '\n') == 1);
    CHECK(result.err.find(mentions) != std::string::npos);
    CHECK(result.out.empty());
    CHECK(folder.names().size() == 7);
  };
  check_failure(2, {"a.pfm", "b.pfm", "--metric", "psnr"}, "--metric");
  check_failure(2, {"a.pfm", "b.pfm", "--map", "map.png"}, "--map: only with --metric flip");
  check_failure(2, {"a.pfm", "b.pfm", "--metric", "flip", "--map", "map.txt"}, "map.txt");
  check_failure(2, {"a.pfm", "b.pfm", "--metric", "flip", "--map", "./a.pfm"}, "--map: would overwrite a.pfm");
  check_failure(2, {"a.pfm", "b.pfm", "--metric", "flip", "--ppd", "1"}, "--ppd");
  check_failure(1, {"a.pfm", "b.pfm", "--metric", "flip", "--map", "none/map.png"}, "none/map.png");
  check_failure(1, {"a.pfm", "small.pfm", "--metric", "flip", "--map", "map.png"}, "24x16 and 3x2");
}

}  // namespace
}  // namespace lanewise
