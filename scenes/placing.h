// What a node's transform makes of what stands in it, the same for every format.
#pragma once

#include <glm/glm.hpp>

#include "core/scene.h"

namespace lanewise {

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

// Takes a mesh from its own space to the world: positions; windings, reversed by a mirroring, with what each
// corner has; normals of any length,
// which become unit ones, and the face's own where they are zero or not finite. The transform must be invertible.
void place_mesh(Mesh& mesh, const glm::dmat4& to_world);

// The frame that a camera keeps of an invertible transform: rotation and place, without scale and mirroring.
glm::dmat4 rigid_frame(const glm::dmat4& to_world);

}  // namespace lanewise
