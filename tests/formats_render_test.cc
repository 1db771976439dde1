// The same picture from every format, through the command line.
#include <doctest/doctest.h>

#include "tests/formats_harness.h"
#include "tests/program.h"
#include "tests/subprocess.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

TEST_CASE("formats: the box of each renders to the same bits as its COLLADA twin") {
  if (test::nothing_to_test()) return;
  const test::TemporaryFolder folder;
  test::write_boxes(folder);
  test::write_text(folder.file("camera.json"),
                   R"({"eye": [0, 1, 4], "target": [0, 1, 0], "up": [0, 1, 0], "xfov": 60})");
  const auto picture = [&](const std::string& name) {
    const auto result = test::run_process(
        test::program(),
        {"render", name, "-c", "camera.json", "-r", "48", "36", "-s", "8", "-q", "--no-estimate", "-f", name + ".pfm"},
        folder.path());
    CAPTURE(result.err);
    CHECK(result.exit_code == 0);
    return test::read_text(folder.file(name + ".pfm"));
  };
  const std::string twin = picture("box.dae");
  CHECK(twin.find_first_not_of('\0', 20) != std::string::npos);
  for (const char* name : {"box.obj", "box.gltf", "box.glb"}) {
    CAPTURE(std::string(name));
    CHECK(picture(name) == twin);
  }
  const auto dark = test::run_process(test::program(), {"render", "box.ply", "-f", "ply.png"}, folder.path());
  CHECK(dark.exit_code == 1);
  CHECK(dark.err.find("no light") != std::string::npos);
}

}  // namespace
}  // namespace lanewise
