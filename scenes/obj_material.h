// Materials of Wavefront .mtl files, as Assimp has read them.
#pragma once

#include <string>
#include <vector>

#include "core/scene.h"
#include "scenes/textures.h"

struct aiMaterial;

namespace lanewise {

// By the first of these that holds:
//   Ke is not black: emission of radiance Ke, from the front alone
//   illum 4, 6, 7, or d < 1 with Ni other than 1: glass of index Ni (1.5 where that is 1 or not given), Tf as its
//     transmittance
//   illum 3 or 5, and Ks is not black: a mirror of reflectance Ks
//   else: diffuse, of reflectance Kd (0.6 where it is not given)
// A texture, map_Kd, is multiplied by Kd (1 where it is not given); grey 0.5 stands for one that is missing. What was left out
// goes to the notices. Throws Error, naming the
// path, for values out of range.
Material read_obj_material(const std::string& path, const aiMaterial& from, Textures& textures,
                           std::vector<std::string>& notices);

}  // namespace lanewise
