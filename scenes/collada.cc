#include "scenes/collada.h"

#include "scenes/collada_document.h"
#include "scenes/collada_library.h"
#include "scenes/collada_light.h"
#include "scenes/collada_node.h"
#include "scenes/collada_size.h"
#include "scenes/collada_transform.h"

namespace lanewise {
namespace {

// The one that <scene> names; a file without <scene> means its first.
pugi::xml_node find_visual_scene(const collada::Document& document) {
  if (const pugi::xml_node instance = document.root().child("scene").child("instance_visual_scene")) {
    return document.refer(instance, "url", "visual_scene");
  }
  const pugi::xml_node first = document.root().child("library_visual_scenes").child("visual_scene");
  if (!first) document.fail(document.root(), "has no <visual_scene>");
  return first;
}

}  // namespace

Scene load_collada(const std::string& path, const std::string& text) {
  const collada::Document document(path, text);
  Scene scene;
  scene.path = path;
  collada::Library library(document, scene);
  const pugi::xml_node root = find_visual_scene(document);
  collada::check_size(document, library, root);
  add_area_lights(instantiate(document, library, root, collada::asset_transform(document), scene), scene);
  finish_scene(scene);
  return scene;
}

}  // namespace lanewise
