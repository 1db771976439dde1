#include "scenes/collada_library.h"

#include "scenes/collada_material.h"

namespace lanewise::collada {
namespace {

// The <instance_material> that the <instance_geometry> has for the symbol; an empty one means the first.
pugi::xml_node binding_of(pugi::xml_node instance, const std::string& symbol) {
  const pugi::xml_node bindings = instance.child("bind_material").child("technique_common");
  if (symbol.empty()) return bindings.child("instance_material");
  return bindings.find_child_by_attribute("instance_material", "symbol", symbol.c_str());
}

}  // namespace

const Geometry& Library::geometry(pugi::xml_node instance) {
  const pugi::xml_node element = document_.refer(instance, "url", "geometry");
  const auto [place, is_new] = geometries_.try_emplace(element.hash_value());
  if (is_new) {
    place->second = read_geometry(document_, arrays_, element);
    for (const std::string& text : place->second.notices) notice(text);
  }
  return place->second;
}

uint32_t Library::material(pugi::xml_node instance, const std::string& symbol, pugi::xml_node user) {
  const pugi::xml_node binding = binding_of(instance, symbol);
  if (binding) return material(document_.refer(binding, "target", "material"));
  if (symbol.empty()) {
    notice("geometry " + quoted(instance.attribute("url").value()) + " has no material: rendered as diffuse grey 0.5");
    return material(pugi::xml_node());
  }
  const pugi::xml_node element = document_.by_id(symbol, "material");
  if (!element) document_.fail(user, "material symbol " + quoted(symbol) + " is bound to no material");
  return material(element);
}

uint32_t Library::material(pugi::xml_node element) {
  const auto [place, is_new] = materials_.try_emplace(element.hash_value());
  if (!is_new) return place->second;
  Material material;
  material.name = "default";
  material.reflectance = glm::dvec3(0.5);
  std::vector<std::string> notices;
  std::string texcoords;
  if (element) material = read_material(document_, element, textures_, texcoords, notices);
  for (const std::string& text : notices) notice(text);
  place->second = static_cast<uint32_t>(scene_.materials.size());
  texcoord_names_[place->second] = texcoords;
  scene_.materials.push_back(material);
  return place->second;
}

std::vector<std::array<glm::dvec2, 3>> Library::texcoords(pugi::xml_node instance, const Part& part,
                                                          uint32_t material) const {
  if (scene_.materials[material].texture == kNoTexture || part.texcoords.empty()) return {};
  const pugi::xml_node input =
      binding_of(instance, part.symbol)
          .find_child_by_attribute("bind_vertex_input", "semantic", texcoord_names_.at(material).c_str());
  if (input) {
    const uint64_t set = document_.count(input, "input_set").value_or(0);
    for (const Part::Texcoords& texcoords : part.texcoords) {
      if (texcoords.set == set) return texcoords.corners;
    }
  }
  return part.texcoords.front().corners;
}

void Library::notice(const std::string& text) {
  if (notices_.insert(text).second) scene_.notices.push_back(text);
}

}  // namespace lanewise::collada
