// Scenes in Wavefront OBJ (.obj with .mtl), Stanford PLY (.ply, ascii or binary) and glTF 2.0 (.gltf, .glb).
//
// Assimp reads the geometry; scenes/obj_material.h and scenes/gltf_material.h say what becomes of materials, and PLY,
// which has none, is diffuse grey 0.5, as is what names no material. The world is the file's, in its own units, with y
// up. glTF: nodes with their transforms, instances, mirrorings; perspective cameras (4 : 3 where a camera gives no
// aspect ratio). A file without a camera gets default_camera. Skipped with a notice: textures, vertex colours, points
// and lines, lights that have no area, animations, skins.
#pragma once

#include <string>

#include "core/scene.h"

namespace lanewise {

// text: the file's bytes; path names it, and its folder is where other files (.mtl, .bin) may be. Throws Error "PATH:
// ...", one line, for what is broken and for more than 2^26 triangles, instances counted.
Scene load_assimp(const std::string& path, const std::string& text);

}  // namespace lanewise
