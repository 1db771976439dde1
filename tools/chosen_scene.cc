#include "tools/chosen_scene.h"

#include <string>

#include "core/types.h"
#include "scenes/camera_file.h"
#include "scenes/environment_file.h"
#include "scenes/load.h"

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

}  // namespace

Scene load_chosen_scene(const RenderOptions& o) {
  Scene scene = load_scene(o.scene);
  apply_overrides(scene, o);
  if (!o.camera_file.empty()) scene.cameras = {load_camera(o.camera_file)};
  if (!o.environment.empty()) scene.environment = load_environment(o.environment);
  check_light(scene);
  return scene;
}

}  // namespace lanewise
