// The plan's flat lists of large faces, tested by whole vectors of rays.
#pragma once

#include <span>

#include "core/plan.h"

namespace lanewise {

// Puts a flat-shaded mesh's triangles into the lists; pairs that form a parallelogram become a quad, whose plane
// becomes that of its primitive. The plan's camera must be placed: the margins of quads cover rays from it.
void add_flat_mesh(Plan& plan, std::span<const FlatTriangle> triangles);

// Puts the faces that can block light between two points of the scene first in their lists, and counts them. triangles
// and spheres: all of the scene's.
void find_blocking_faces(Plan& plan, std::span<const FlatTriangle> triangles, std::span<const FlatSphere> spheres);

// Light from the environment comes in over the scene's hull, whose faces then block it, too. To be called last.
void let_all_faces_block(Plan& plan);

// Pairs quads that block no light to slabs and puts them last in their list. To be called after find_blocking_faces.
void find_slabs(Plan& plan);

}  // namespace lanewise
