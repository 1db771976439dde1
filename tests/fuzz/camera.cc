// The JSON files of cameras.
#include "scenes/camera_file.h"
#include "tests/fuzz/harness.h"

namespace lanewise::fuzz {
namespace {

// In front of a sphere, which it need not see.
const Harness harness("camera", ".json", [](const std::string& path) {
  Scene scene;
  scene.path = path;
  scene.materials.push_back({.name = "light", .kind = Material::Kind::kEmission, .radiance = glm::dvec3(1)});
  scene.spheres.push_back({});
  scene.cameras.push_back(load_camera(path));
  finish_scene(scene);
  use(scene);
});

}  // namespace
}  // namespace lanewise::fuzz
