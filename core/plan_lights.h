// The plan's lights: emissive meshes as patches that are sampled by area, emissive spheres.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "core/plan.h"

namespace lanewise {

// Appends a light made of these triangles. Pairs of triangles that share an edge and form a parallelogram become one
// patch: fewer patches, and a smoother map from the unit square.
void add_mesh_light(Plan& plan, std::span<const FlatTriangle> triangles, const glm::dvec3& radiance);

void add_sphere_light(Plan& plan, const FlatSphere& sphere, const glm::dvec3& radiance);

}  // namespace lanewise
