// What must hold of a glTF file before a library reads its geometry.
#pragma once

#include "scenes/json_value.h"

namespace lanewise {

// Throws Error: see GltfDocument's constructor.
void check_gltf(const JsonValue& root);

}  // namespace lanewise
