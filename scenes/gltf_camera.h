// Cameras of glTF 2.0.
#pragma once

#include <glm/glm.hpp>

#include "core/scene.h"
#include "scenes/json_value.h"

namespace lanewise {

// An element of "cameras" of the type "perspective", seen from its node. Throws Error for fields of view and aspect
// ratios out of range.
Camera read_gltf_camera(const JsonValue& camera, const glm::dmat4& to_world);

}  // namespace lanewise
