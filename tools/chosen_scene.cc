#include "tools/chosen_scene.h"

#include <algorithm>
#include <string>

#include "core/types.h"
#include "scenes/camera_file.h"
#include "scenes/environment_file.h"
#include "scenes/load.h"
#include "scenes/quoted.h"

namespace lanewise {
namespace {

template <class F>
void change_materials(Scene& scene, Material::Kind kind, const char* flag, const char* what, F change) {
  bool any = false;
  for (Material& material : scene.materials) {
    if (material.kind != kind) continue;
    change(material);
    any = true;
  }
  if (!any) throw UsageError(std::string(flag) + ": " + scene.path + " has no " + what);
}

void apply_overrides(Scene& scene, const RenderOptions& o) {
  constexpr auto kMicrofacet = Material::Kind::kMicrofacet;
  if (o.metal) {
    change_materials(scene, kMicrofacet, "--metal", "microfacet material", [&](Material& m) {
      m.eta = o.metal->eta;
      m.k = o.metal->k;
    });
  }
  if (o.alpha) {
    change_materials(scene, kMicrofacet, "--alpha", "microfacet material", [&](Material& m) { m.alpha = *o.alpha; });
  }
  if (o.ior) change_materials(scene, Material::Kind::kGlass, "--ior", "glass", [&](Material& m) { m.ior = *o.ior; });
  apply_normals(scene, o.normals);
}

// The one of this name, or without a name the first; it is then the scene's only one.
void choose_camera(Scene& scene, const std::string& name) {
  std::string all;
  for (const Camera& camera : scene.cameras) all += (all.empty() ? "" : ", ") + lanewise::quoted(camera.name);
  if (name.empty()) {
    if (scene.cameras.size() > 1) {
      scene.notices.push_back(std::to_string(scene.cameras.size()) + " cameras: " + all +
                              "; the first is used, --camera chooses");
    }
    scene.cameras.resize(1);
    return;
  }
  const auto found = std::ranges::find(scene.cameras, name, &Camera::name);
  if (found == scene.cameras.end()) {
    throw UsageError("--camera: " + scene.path + " has no camera " + lanewise::quoted(name) + "; there is " + all);
  }
  scene.cameras = {Camera(*found)};
}

}  // namespace

Scene load_chosen_scene(const RenderOptions& o) {
  Scene scene = load_scene(o.scene);
  apply_overrides(scene, o);
  if (!o.camera_file.empty()) {
    scene.cameras = {load_camera(o.camera_file, scene.up)};
  } else {
    choose_camera(scene, o.camera);
  }
  if (!o.environment.empty()) scene.environment = load_environment(o.environment);
  check_light(scene);
  return scene;
}

}  // namespace lanewise
