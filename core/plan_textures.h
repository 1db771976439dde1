// The plan's textures, and where in them its triangles lie.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>

#include "core/plan.h"
#include "core/scene.h"

namespace lanewise {

// Adds the textures that a mesh shows, and their numbers to the materials, which are there already; none if no mesh does.
// Throws Error for more than 2^30 texels.
void add_textures(const Scene& scene, Plan& plan);

// Adds to prim_texture for a triangle with corners v, relative to the plan's centre, and unit normal n. The map from its
// plane to texels is affine, so that a hit point needs no barycentric weights, and both halves of a parallelogram may share
// one.
void map_triangle(const Scene& scene, const Mesh& mesh, size_t triangle, const glm::dvec3 (&v)[3], const glm::dvec3& n,
                  Plan& plan);

}  // namespace lanewise
