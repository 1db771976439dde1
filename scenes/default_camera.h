// A camera for files that have none.
#pragma once

#include "core/scene.h"

namespace lanewise {

// Sees all of the scene, which must have geometry, from the front and 10 degrees above: from +z where y is up
// (Scene::up), as glTF has its front, and from -y where z is; a field of view of 40 degrees, 4 : 3.
Camera default_camera(const Scene& scene);

}  // namespace lanewise
