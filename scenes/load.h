// Scenes from files and from code.
#pragma once

#include <string>

#include "core/scene.h"

namespace lanewise {

// Loads a scene, by the name's form:
//   FILE.dae           COLLADA 1.4.1 (scenes/collada.h says what of it is understood)
//   FILE.obj, FILE.ply, FILE.gltf, FILE.glb   (scenes/assimp_scene.h)
//   builtin:NAME       a scene made by code (scenes/builtin.h)
// The result has been through finish_scene. Throws Error, one line that names the file (and the line in it, where there
// is one) and what is wrong.
Scene load_scene(const std::string& path);

}  // namespace lanewise
