#include "scenes/camera_file.h"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "core/types.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

std::string write(const test::TemporaryFolder& folder, const std::string& text) {
  const std::string path = folder.file("camera.json");
  std::ofstream(path) << text;
  return path;
}

}  // namespace

TEST_CASE("camera file: eye, target, up and field of view") {
  const test::TemporaryFolder folder;
  const Camera camera = load_camera(
      write(folder, R"({"eye": [1, -4, 2], "target": [1, 0, 2], "up": [0, 0, 2], "xfov": 60, "aspect": 1.5})"));
  CHECK(camera.xfov == doctest::Approx(std::numbers::pi / 3));
  CHECK(camera.aspect == 1.5);
  CHECK(glm::length(glm::dvec3(camera.to_world[0]) - glm::dvec3(1, 0, 0)) < 1e-12);
  CHECK(glm::length(glm::dvec3(camera.to_world[1]) - glm::dvec3(0, 0, 1)) < 1e-12);
  CHECK(glm::length(glm::dvec3(camera.to_world[2]) - glm::dvec3(0, -1, 0)) < 1e-12);
  CHECK(glm::dvec3(camera.to_world[3]) == glm::dvec3(1, -4, 2));
  CHECK(load_camera(write(folder, R"({"eye": [0,0,1], "target": [3,0,1], "xfov": 40})")).aspect == 4.0 / 3.0);
}

TEST_CASE("camera file: what is wrong is said in one line with the file's name") {
  const test::TemporaryFolder folder;
  const std::pair<const char*, const char*> bad[] = {
      {"", "not JSON"},
      {"{", "not JSON"},
      {"[1, 2]", "JSON object"},
      {R"({"target": [0,0,0], "xfov": 40})", "eye"},
      {R"({"eye": [0,0], "target": [0,0,0], "xfov": 40})", "eye"},
      {R"({"eye": [0,0,"1"], "target": [0,0,0], "xfov": 40})", "eye"},
      {R"({"eye": [0,0,1e300], "target": [0,0,0], "xfov": 40})", "eye"},
      {R"({"eye": [0,0,1], "target": [0,0,1], "xfov": 40})", "same point"},
      {R"({"eye": [0,0,1], "target": [0,0,0], "xfov": 40})", "up"},
      {R"({"eye": [0,1,1], "target": [0,0,0], "xfov": 180})", "xfov"},
      {R"({"eye": [0,1,1], "target": [0,0,0], "xfov": "wide"})", "xfov"},
      {R"({"eye": [0,1,1], "target": [0,0,0], "xfov": 40, "aspect": 0})", "aspect"},
      {R"({"eye": [0,1,1], "target": [0,0,0], "xfov": 40, "fov": 3})", "fov"},
  };
  for (const auto& [text, reason] : bad) {
    INFO(std::string(text));
    const std::string path = write(folder, text);
    try {
      load_camera(path);
      FAIL_CHECK("accepted");
    } catch (const Error& e) {
      const std::string what = e.what();
      CAPTURE(what);
      CHECK(what.starts_with(path));
      CHECK(what.find(reason) != std::string::npos);
      CHECK(what.find('\n') == std::string::npos);
    }
  }
  CHECK_THROWS_AS(load_camera(folder.file("missing.json")), Error);
  CHECK_THROWS_AS(load_camera(folder.path().string()), Error);
}

}  // namespace lanewise
