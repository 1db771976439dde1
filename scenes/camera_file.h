// A camera in a file of its own, to view a scene otherwise than its authors.
#pragma once

#include <string>

#include "core/scene.h"

namespace lanewise {

// Reads a JSON object:
//   {"eye": [0, -4, 1], "target": [0, 0, 0.75], "up": [0, 0, 1], "xfov": 49.1, "aspect": 1.3333}
// eye and target are points in the scene's coordinates and must differ; up (default_up if it is not given) must not
// point along the view; xfov is the horizontal field of view in degrees, in (0, 180); aspect (default 4/3) the width of
// that view over its height. Throws Error that names the file and the member.
Camera load_camera(const std::string& path, const glm::dvec3& default_up = {0, 0, 1});

}  // namespace lanewise
