// `lanewise info` from outside. LANEWISE_BINARY names the program, LANEWISE_SOURCE_DIR the checkout.
#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>

#include "scenes/inspect.h"
#include "scenes/load.h"
#include "tests/formats_harness.h"
#include "tests/program.h"
#include "tests/subprocess.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

using nlohmann::json;
using test::box;
using test::nothing_to_test;
using test::ProcessResult;
using test::program;
using test::TemporaryFolder;
using Arguments = std::vector<std::string>;

ProcessResult info(const TemporaryFolder& folder, const Arguments& arguments) {
  Arguments all = {"info"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return test::run_process(program(), all, folder.path());
}

TEST_CASE("info command: counts, bounds, materials, lights and cameras") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const ProcessResult text = info(folder, {box()});
  CHECK(text.exit_code == 0);
  CHECK(text.err.empty());
  for (const char* part :
       {" triangles in ", ", 2 spheres, 1 light, 1 camera", "z is up", "mirror", "glass", "ior 1.5"}) {
    CAPTURE(std::string(part));
    CHECK(text.out.find(part) != std::string::npos);
  }
  CHECK(text.out.find("warning") == std::string::npos);
  const ProcessResult result = info(folder, {box(), "--json"});
  CHECK(result.exit_code == 0);
  const json told = json::parse(result.out);
  const Scene scene = load_scene(box());
  CHECK(told["scene"] == box());
  CHECK(told["meshes"] == scene.meshes.size());
  CHECK(told["triangles"] == scene.triangle_count());
  CHECK(told["spheres"] == 2);
  CHECK(told["bounds"]["lo"][0].get<double>() == doctest::Approx(bounds(scene).lo.x));
  CHECK(told["materials"].size() == scene.materials.size());
  size_t triangles = 0;
  for (const json& material : told["materials"]) triangles += material["triangles"].get<size_t>();
  CHECK(triangles == scene.triangle_count());
  REQUIRE(told["lights"].size() == 1);
  const json& light = told["lights"][0];
  CHECK(light["power"][1].get<double>() ==
        doctest::Approx(std::numbers::pi * light["area"].get<double>() * light["radiance"][1].get<double>()));
  CHECK(told["cameras"][0]["xfov"].get<double>() == doctest::Approx(scene.cameras[0].xfov * 180 / std::numbers::pi));
  CHECK(told["warnings"].empty());
}

TEST_CASE("info command: other formats, what the loader decided, and no light") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  test::write_boxes(folder);
  const ProcessResult ply = info(folder, {"box.ply"});
  CHECK(ply.exit_code == 0);
  for (const char* part : {"box.ply: 6 triangles in 1 mesh, 0 spheres, 0 lights, 1 camera", "y is up",
                           "note: what has no material", "note: no camera", "warning: nothing emits light"}) {
    CAPTURE(std::string(part));
    CHECK(ply.out.find(part) != std::string::npos);
  }
  const json glb = json::parse(info(folder, {"box.glb", "--json"}).out);
  CHECK(glb["lights"][0]["area"] == 1.0);
  CHECK(glb["materials"].size() == 3);
}

bool warns(const Scene& scene, const std::string& part) {
  const std::vector<std::string> warnings = scene_warnings(scene);
  return std::ranges::any_of(warnings, [&](const std::string& w) { return w.find(part) != std::string::npos; });
}

// A closed tetrahedron of glass, a lamp above that faces it, and a camera that sees both.
Scene glass_scene() {
  Scene scene;
  scene.materials.resize(2);
  scene.materials[0].kind = Material::Kind::kGlass;
  scene.materials[1].kind = Material::Kind::kEmission;
  scene.materials[1].radiance = glm::dvec3(1.0);
  Mesh body, lamp;
  body.name = "body";
  body.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  body.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  lamp.name = "lamp";
  lamp.positions = {{0, 0, 2}, {0, 1, 2}, {1, 0, 2}};
  lamp.triangles = {{0, 1, 2}};
  lamp.material = 1;
  scene.meshes = {body, lamp};
  scene.cameras.emplace_back();
  scene.cameras[0].to_world[3].z = 5;
  return scene;
}

TEST_CASE("scene warnings: each has a scene that it is for, and a sound scene has none") {
  CHECK(scene_warnings(glass_scene()).empty());

  Scene scene = glass_scene();
  scene.meshes[0].triangles.pop_back();
  CHECK(warns(scene, "\"body\" is glass and open: 3 edges have one face"));
  // The face that is missing in a mesh of its own, its corners at the same places: closed again.
  Mesh rest = glass_scene().meshes[0];
  rest.triangles = {rest.triangles.back()};
  scene.meshes.push_back(rest);
  CHECK(scene_warnings(scene).empty());

  scene = glass_scene();
  std::swap(scene.meshes[0].triangles[0][0], scene.meshes[0].triangles[0][1]);
  CHECK(warns(scene, "3 edges whose faces disagree"));

  scene = glass_scene();
  scene.meshes.push_back(rest);
  CHECK(warns(scene, "3 edges of more than two faces"));
  CHECK(warns(scene, "1 triangle of mesh \"body\" lies exactly on those of mesh \"body\""));

  scene = glass_scene();
  std::swap(scene.meshes[1].triangles[0][0], scene.meshes[1].triangles[0][1]);
  CHECK(warns(scene, "light \"lamp\" has nothing in front"));
  scene.materials[1].radiance = glm::dvec3(0.0);
  CHECK(warns(scene, "nothing emits light"));

  scene = glass_scene();
  scene.cameras[0].to_world[3].z = -5;
  CHECK(warns(scene, "has the whole scene behind it"));

  scene = glass_scene();
  scene.materials[0].kind = Material::Kind::kDiffuse;
  scene.materials[0].reflectance = {0.5, 1, 0.5};
  CHECK(warns(scene, "reflects all light"));
}

TEST_CASE("info command: wrong input gives one line and an exit code") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  test::write_text(folder.file("bad.gltf"), "{");
  const std::pair<Arguments, int> wrong[] = {{{}, 2}, {{box(), "--yaml"}, 2}, {{"none.dae"}, 1}, {{"bad.gltf"}, 1}};
  for (const auto& [arguments, exit_code] : wrong) {
    const ProcessResult result = info(folder, arguments);
    CAPTURE(result.err);
    CHECK(result.exit_code == exit_code);
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    CHECK(result.out.empty());
  }
}

}  // namespace
}  // namespace lanewise
