// <light>: CGL area lights, which become emissive meshes.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "core/scene.h"
#include "scenes/collada_document.h"

namespace lanewise::collada {

// A parallelogram that emits to the side that sees its corners in counter-clockwise order.
struct AreaLight {
  std::string name;
  std::array<glm::dvec3, 4> corners;
  glm::dvec3 radiance{0.0};
};

// The light seen from its node, whose transform takes the unit square in xy and its emitting side, -z; nothing if it is
// not an area light.
std::optional<AreaLight> read_area_light(const Document& document, pugi::xml_node element, const glm::dmat4& to_world);

// Adds each light to the scene as a mesh, except where an emissive mesh lies already: that mesh is then the light, as
// it is the one to be seen, and a notice says so.
void add_area_lights(const std::vector<AreaLight>& lights, Scene& scene);

}  // namespace lanewise::collada
