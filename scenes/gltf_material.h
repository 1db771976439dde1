// Materials of glTF 2.0.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "core/scene.h"
#include "scenes/json_value.h"

namespace lanewise {

// An element of "materials", by the first of these that holds:
//   emissiveFactor times KHR_materials_emissive_strength is not black: emission of that radiance, from the front alone
//   transmissionFactor (KHR_materials_transmission) >= 0.5: glass of index KHR_materials_ior (1.5), base colour as its
//     transmittance, of Beckmann roughness alpha = roughness^2 where a roughness is given
//   metallicFactor >= 0.5: with roughness below 0.01 a mirror of the base colour, otherwise a metal of Beckmann
//     roughness alpha = roughness^2 (glTF's own distribution is GGX) whose reflectance head on is the base colour
//   else: diffuse, of the base colour; the coat that glTF gives such surfaces is left out
// The base colour of a diffuse surface may be textured. Other textures are not read: half of the base colour stands for one of
// that, and the other factors are as they are. What was left out goes to the notices. Throws Error for values out of range.
// texture_of: the texture of the scene that a textureInfo means, or kNoTexture.
Material read_gltf_material(const JsonValue& material, const std::function<uint32_t(const JsonValue&)>& texture_of,
                            std::vector<std::string>& notices);

// Index and extinction of a metal with this reflectance head on, each value in [0, 1), by Gulbrandsen, Artist Friendly
// Metallic Fresnel (JCGT 3(4), 2014), with the edge tint 1 - (1 - r)^2.7, which is fitted here to Schlick's formula:
// off by at most 0.04 at any angle for r >= 0.04, and by 0.015 in the mean over the cosine.
void metal_of_reflectance(double reflectance, double& eta, double& k);

}  // namespace lanewise
