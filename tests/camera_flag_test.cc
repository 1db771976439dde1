// --camera from outside: which of a scene's cameras the picture is seen from.
#include <doctest/doctest.h>

#include <algorithm>

#include "tests/formats_harness.h"
#include "tests/program.h"
#include "tests/subprocess.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

using nlohmann::json;
using test::ProcessResult;
using test::TemporaryFolder;

// The box with a second camera, "above".
void write_scene(const TemporaryFolder& folder) {
  test::write_text(folder.file("box.bin"), test::box_buffer());
  json gltf = test::box_gltf();
  gltf["nodes"].push_back({{"name", "above"}, {"camera", 0}, {"translation", {0, 1.5, 4}}});
  gltf["scenes"][0]["nodes"].push_back(4);
  test::write_text(folder.file("box.gltf"), gltf.dump());
  gltf["nodes"][0] = gltf["nodes"][4];
  gltf["scenes"][0]["nodes"] = {0, 1, 2, 3};
  test::write_text(folder.file("above.gltf"), gltf.dump());
}

ProcessResult render(const TemporaryFolder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "render");
  for (const char* word : {"-r", "32", "24", "-s", "2", "--no-estimate"}) arguments.push_back(word);
  return test::run_process(test::program(), arguments, folder.path());
}

TEST_CASE("--camera: the named one, the first without it, and a notice that there are several") {
  if (test::nothing_to_test()) return;
  const TemporaryFolder folder;
  write_scene(folder);
  const ProcessResult first = render(folder, {"box.gltf", "-f", "first.pfm"});
  CHECK(first.exit_code == 0);
  CHECK(first.out.find("note: 2 cameras: \"camera\", \"above\"; the first is used") != std::string::npos);
  CHECK(render(folder, {"box.gltf", "--camera", "camera", "-f", "same.pfm"}).exit_code == 0);
  const ProcessResult second = render(folder, {"box.gltf", "--camera", "above", "-f", "second.pfm"});
  CHECK(second.exit_code == 0);
  CHECK(second.out.find("cameras") == std::string::npos);
  CHECK(render(folder, {"above.gltf", "-f", "alone.pfm"}).exit_code == 0);
  const auto picture = [&](const char* name) { return test::read_text(folder.file(name)); };
  CHECK(picture("first.pfm") == picture("same.pfm"));
  CHECK(picture("second.pfm") == picture("alone.pfm"));
  CHECK(picture("first.pfm") != picture("second.pfm"));
}

TEST_CASE("--camera: an unknown name lists those there are") {
  if (test::nothing_to_test()) return;
  const TemporaryFolder folder;
  write_scene(folder);
  const ProcessResult unknown = render(folder, {"box.gltf", "--camera", "below"});
  CHECK(unknown.exit_code == 2);
  CHECK(unknown.err.find("has no camera \"below\"; there is \"camera\", \"above\"") != std::string::npos);
  const ProcessResult both = render(folder, {"box.gltf", "--camera", "above", "-c", "camera.json"});
  CHECK(both.exit_code == 2);
  CHECK(both.err.find("--camera") != std::string::npos);
  const ProcessResult plan =
      test::run_process(test::program(), {"plan", "box.gltf", "--camera", "below"}, folder.path());
  CHECK(plan.exit_code == 2);
}

}  // namespace
}  // namespace lanewise
