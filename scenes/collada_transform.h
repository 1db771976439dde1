// What places things: the transform elements of a node, and the file's axes and unit.
#pragma once

#include <glm/glm.hpp>
#include <pugixml.hpp>

#include "scenes/collada_document.h"
#include "scenes/placing.h"

namespace lanewise::collada {

// From the file's axes and unit to z up and metres. Without <up_axis>, y is up, as the specification has it.
glm::dmat4 asset_transform(const Document& document);

// The product of the node's transform elements in document order, as points see it from right to left. Fails for
// matrices that are short, singular or not affine.
glm::dmat4 node_transform(const Document& document, pugi::xml_node node);

}  // namespace lanewise::collada
