// Scenes made by code.
#pragma once

#include <string>

#include "core/scene.h"

namespace lanewise {

constexpr const char* kBuiltinPrefix = "builtin:";

// "builtin:dense" or "builtin:dense:N": a rippled torus knot of gold, some 200,000 or N triangles (1,000 to 20,000,000)
// with smooth normals, in a Cornell box. Throws Error for other names.
Scene load_builtin(const std::string& name);

}  // namespace lanewise
