// The plan's trees: what is not in its flat lists.
#pragma once

#include <span>

#include "core/plan.h"

namespace lanewise {

// Builds plan.triangle_tree and packs its leaves into plan.triangle_blocks, which take the place of its leaf_prims.
void plant_triangles(Plan& plan, std::span<const FlatTriangle> triangles);

// The same for spheres.
void plant_spheres(Plan& plan, std::span<const FlatSphere> spheres);

}  // namespace lanewise
