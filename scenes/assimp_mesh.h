// Meshes as Assimp has read them.
#pragma once

#include <string>
#include <vector>

#include "core/scene.h"

struct aiMesh;

namespace lanewise {

// In its own space. Vertices at the same place are one, so that smooth normals see which faces meet; polygons, which
// must be convex, are fans around their first vertex; points and lines are left out. Normals are of any length; none:
// the file has none. Throws Error, naming the path, for indices out of range.
Mesh read_mesh(const std::string& path, const aiMesh& from);

}  // namespace lanewise
