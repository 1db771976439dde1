// What places things: the transform elements of a node, and the file's axes and unit.
#pragma once

#include <glm/glm.hpp>
#include <pugixml.hpp>

#include "scenes/collada_document.h"

namespace lanewise::collada {

// From the file's axes and unit to z up and metres. Without <up_axis>, y is up, as the specification has it.
glm::dmat4 asset_transform(const Document& document);

// The product of the node's transform elements in document order, as points see it from right to left. Fails for
// matrices that are short, singular or not affine.
glm::dmat4 node_transform(const Document& document, pugi::xml_node node);

// Whether the linear part is finite and, its columns brought to a size of one, so that tiny and huge scales are not
// taken for singular, has a determinant that is not 0.
bool invertible(const glm::dmat4& transform);

// A transform's linear part, for what is not a point.
struct Linear {
  glm::dmat3 cofactor;  // takes normals to normals that keep their side; not of unit length
  bool mirrored;        // left and right are exchanged: windings must be reversed to keep the front in front
  double scale;         // cube root of the determinant's size
  bool uniform;         // a rotation or reflection times scale, to the six digits that files carry
};
// Of an invertible transform.
Linear linear_part(const glm::dmat4& transform);

}  // namespace lanewise::collada
