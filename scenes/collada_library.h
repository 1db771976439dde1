// What nodes instantiate, each read once, on first use.
#pragma once

#include <cstdint>
#include <pugixml.hpp>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "core/scene.h"
#include "scenes/collada_document.h"
#include "scenes/collada_geometry.h"
#include "scenes/textures.h"

namespace lanewise::collada {

class Library {
 public:
  // Materials and notices go to the scene. Both arguments must outlive the library.
  Library(const Document& document, Scene& scene)
      : document_(document), scene_(scene), arrays_(document), textures_(scene) {}

  // The <geometry> that the <instance_geometry> refers to.
  const Geometry& geometry(pugi::xml_node instance);

  // The index in the scene of the material that the <instance_geometry> binds to the symbol of `user`, an element for
  // errors; without a binding the material whose id the symbol is. An empty symbol means the first binding, or a
  // default grey if there is none.
  uint32_t material(pugi::xml_node instance, const std::string& symbol, pugi::xml_node user);

  // Of the part, as instantiated, with that material: the texture coordinates that the binding says, or its first; empty if it
  // has none or needs none.
  std::vector<std::array<glm::dvec2, 3>> texcoords(pugi::xml_node instance, const Part& part, uint32_t material) const;

  // Adds a notice to the scene unless it has been given before.
  void notice(const std::string& text);

 private:
  uint32_t material(pugi::xml_node element);

  const Document& document_;
  Scene& scene_;
  ArrayCache arrays_;
  Textures textures_;
  std::unordered_map<size_t, Geometry> geometries_;  // by hash_value, an element's identity
  std::unordered_map<size_t, uint32_t> materials_;
  std::unordered_map<uint32_t, std::string>
      texcoord_names_;  // by material: what a binding calls the coordinates that it needs
  std::unordered_set<std::string> notices_;
};

}  // namespace lanewise::collada
