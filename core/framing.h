// What of a scene the picture shows.
#pragma once

#include <glm/glm.hpp>

#include "core/scene.h"
#include "core/settings.h"

namespace lanewise {

// A pinhole, or the centre of a lens.
struct Framing {
  glm::dvec3 eye;              // relative to the centre of the scene's bounds
  glm::dvec3 right, up, back;  // orthonormal, right-handed; the view is along -back
  double pixel;                // a pixel's side at distance 1 (square pixels): 1 / focal length in pixels
};

// By settings.view: the scene's first camera, whose field of view grows with the picture's shape to hold all of the
// camera's own; or the course program's framing: 1.5 diagonals back from the centre along the camera's axis, with a
// focal length of 600 / (2 tan(vfov / 2)) pixels whatever the resolution, and the scene's up upright.
Framing frame(const Scene& scene, const Settings& settings);

}  // namespace lanewise
