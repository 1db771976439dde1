// <material> and its <effect>: the renderer's materials.
#pragma once

#include <pugixml.hpp>
#include <string>
#include <vector>

#include "core/scene.h"
#include "scenes/collada_document.h"
#include "scenes/textures.h"

namespace lanewise::collada {

// What the <material> means: its effect's CGL extra if it has one, else the colours of its common profile, and the texture of
// its diffuse one; texcoords becomes what bindings call the coordinates in that. Adds to notices what is rendered otherwise
// than the file says. Fails for unknown CGL materials and values out of range.
Material read_material(const Document& document, pugi::xml_node element, Textures& textures, std::string& texcoords,
                       std::vector<std::string>& notices);

// Radiance in an element: 3 numbers, >= 0, W / (m^2 sr).
glm::dvec3 read_radiance(const Document& document, pugi::xml_node node);

}  // namespace lanewise::collada
