// <geometry>: triangle meshes and spheres in their own space.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "scenes/collada_document.h"
#include "scenes/collada_source.h"

namespace lanewise::collada {

// One primitive element's triangles: what one material symbol covers.
struct Part {
  // Where in textures each triangle's corners are, by one of the element's inputs TEXCOORD.
  struct Texcoords {
    uint64_t set;
    std::vector<std::array<glm::dvec2, 3>> corners;
  };

  pugi::xml_node element;
  std::string symbol;                              // its material's; empty: none
  std::vector<glm::dvec3> positions;               // those that the triangles use
  std::vector<std::array<uint32_t, 3>> triangles;  // indices into positions
  std::vector<std::array<glm::dvec3, 3>> normals;  // as in the file, of any length; empty: it has none
  std::vector<Texcoords> texcoords;                // read if the document has images
};

struct Geometry {
  pugi::xml_node element;
  std::vector<Part> parts;
  double radius = 0;                 // above 0: a sphere around the origin, and no parts
  std::vector<std::string> notices;  // what was left out
};

// Fails, besides for broken references and numbers, if counts disagree, an index is out of range or a radius is not >
// 0.
Geometry read_geometry(const Document& document, ArrayCache& arrays, pugi::xml_node element);

}  // namespace lanewise::collada
