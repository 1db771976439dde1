// What `lanewise info` tells.
#pragma once

#include <string>

#include "core/scene.h"

namespace lanewise {

// For the terminal: two lines, tables of materials, lights and cameras, notes and warnings.
std::string info_text(const Scene& scene);

// {"scene", "version", "meshes", "triangles", "spheres", "bounds": {"lo", "hi"}, "size", "up", "materials": [{"name",
// "kind", "triangles", "spheres", the kind's values}], "lights": [{"name", "area", "radiance", "power"}], "cameras":
// [{"name", "xfov" (degrees), "aspect", "eye", "view"}], "notices", "warnings"}
std::string info_json(const Scene& scene);

}  // namespace lanewise
