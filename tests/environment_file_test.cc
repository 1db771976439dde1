#include "scenes/environment_file.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "core/environment_map.h"
#include "core/image_io.h"
#include "core/types.h"
#include "tests/program.h"
#include "tests/subprocess.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

Image map_with(float value) {
  Image map(4, 2);
  for (float& x : map.rgb) x = 0.5f;
  map.pixel(3, 1)[2] = value;
  return map;
}

// The message that loading throws, after checks that it is one line and names the file.
std::string error_of(const std::string& path) {
  try {
    load_environment(path);
  } catch (const Error& error) {
    const std::string message = error.what();
    CHECK(message.starts_with(path));
    CHECK(message.find('\n') == std::string::npos);
    return message.substr(path.size());
  }
  return "loaded";
}

}  // namespace

TEST_CASE("environment file: radiance as it is") {
  const test::TemporaryFolder folder;
  for (const char* name : {"sky.exr", "sky.pfm", "sky.hdr"}) {
    write_image(folder.file(name), map_with(2));
    const Image map = load_environment(folder.file(name));
    CHECK(map.width == 4);
    CHECK(map.rgb == map_with(2).rgb);
  }
}

TEST_CASE("environment file: what is wrong is said in one line with the file's name") {
  const test::TemporaryFolder folder;
  const auto wrong = [&](const std::string& name, float value) {
    write_image(folder.file(name), map_with(value));
    return error_of(folder.file(name));
  };
  CHECK(wrong("negative.exr", -1) == ": the texel in column 3 of row 1 is negative");
  CHECK(wrong("negative.pfm", -1e-30f) == ": the texel in column 3 of row 1 is negative");
  CHECK(wrong("nan.exr", std::numeric_limits<float>::quiet_NaN()) == ": the texel in column 3 of row 1 is not finite");
  CHECK(wrong("inf.pfm", std::numeric_limits<float>::infinity()) == ": the texel in column 3 of row 1 is not finite");
  CHECK(wrong("colours.png", 0.5f).find("holds radiance") != std::string::npos);
  write_image(folder.file("wide.pfm"), Image(kMaxEnvironmentSide + 1, 1));
  CHECK(error_of(folder.file("wide.pfm")).find(": 65537 x 1 are more texels") == 0);
  CHECK(error_of(folder.file("missing.hdr")).find("cannot read") != std::string::npos);
  CHECK(error_of(folder.file("sky.txt")).find("must end in") != std::string::npos);
  test::write_text(folder.file("bad.hdr"), "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\nshort");
  CHECK(error_of(folder.file("bad.hdr")).find("ends early") != std::string::npos);
  test::write_text(folder.file("bad.exr"), "no picture");
  CHECK(error_of(folder.file("bad.exr")).find("cannot read") != std::string::npos);
}

TEST_CASE("environment file: `lanewise render` lights a scene by it, which without is none to render") {
  if (test::nothing_to_test()) return;
  const test::TemporaryFolder folder;
  const std::string scenes = test::environment("LANEWISE_SOURCE_DIR", ".") + "/scenes/";
  const auto render = [&](std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"render", scenes + "outdoors.dae", "-r", "16", "12", "-s", "4", "-q", "-f", "a.pfm"});
    return test::run_process(test::program(), flags, folder.path());
  };
  const test::ProcessResult dark = render({});
  CHECK(dark.exit_code == 1);
  CHECK(dark.err.find("the scene has no light") != std::string::npos);
  write_image(folder.file("black.exr"), Image(4, 2));
  CHECK(render({"-e", "black.exr"}).exit_code == 1);
  CHECK(render({"-e", "missing.exr"}).exit_code == 1);
  CHECK(folder.names().size() == 1);
  CHECK(render({"-e", scenes + "sky.hdr"}).exit_code == 0);
  const Image image = read_image(folder.file("a.pfm"));
  CHECK(std::ranges::all_of(image.rgb, [](float x) { return x > 0; }));
  const test::ProcessResult over = render({"-e", "a.pfm"});
  CHECK(over.exit_code == 2);
  CHECK(over.err.find("would overwrite a.pfm") != std::string::npos);
}

TEST_CASE(
    "environment file: `lanewise convert` gives Mitsuba a map with rows at the poles that interpolates to the same") {
  if (test::nothing_to_test()) return;
  const test::TemporaryFolder folder;
  const std::string scenes = test::environment("LANEWISE_SOURCE_DIR", ".") + "/scenes/";
  const auto convert = [&](const std::string& sky) {
    return test::run_process(test::program(), {"convert", scenes + "outdoors.dae", "-e", sky, "-f", "a.xml"},
                             folder.path());
  };
  CHECK(convert(scenes + "sky.hdr").exit_code == 0);
  const Image map = load_environment(scenes + "sky.hdr"), rows = load_environment(folder.file("a_meshes/sky.pfm"));
  REQUIRE(rows.width == map.width);
  REQUIRE(rows.height == 2 * map.height + 1);
  for (uint32_t y = 0; y < rows.height; ++y) {
    const uint32_t upper = y > 1 ? (y - 1) / 2 : 0, lower = std::min(y / 2, map.height - 1);
    CHECK(rows.pixel(7, y)[1] == doctest::Approx((map.pixel(7, upper)[1] + map.pixel(7, lower)[1]) / 2));
  }
  CHECK(test::read_text(folder.file("a.xml")).find("a_meshes/sky.pfm") != std::string::npos);
  Image one_texel(1, 1);
  one_texel.rgb = {1, 2, 3};
  write_image(folder.file("one.pfm"), one_texel);
  CHECK(convert("one.pfm").exit_code == 0);
  CHECK(load_environment(folder.file("a_meshes/sky.pfm")).width == 2);
}

}  // namespace lanewise
