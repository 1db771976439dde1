// COLLADA 1.4.1 scenes.
//
// Read: meshes of triangles, tristrips, trifans, polylists and polygons (convex ones; holes are filled, with a notice),
// with normals; every transform element; nested and instanced nodes; up_axis and unit, converted to z up and metres;
// perspective cameras; diffuse (or emission) colours of phong, lambert, blinn and constant effects; and, in <extra>
// techniques of profile CGL:
//   effects      <mirror> reflectance; <glass> or <refraction> reflectance, transmittance, roughness, ior;
//                <microfacet> alpha, eta, k; <emission> radiance; <diffuse> or <lambertian> reflectance or albedo
//   geometries   <sphere> radius
//   lights       <area> color: the unit square around the light node's origin in its xy plane emits it towards -z.
//                Where an emissive mesh lies, that mesh is the light and the area light is dropped.
// and the textures of diffuse colours, with the texture coordinates that a binding names. Skipped with a notice: other lights,
// lines, splines, controllers. Unknown elements, and textures of anything else, are skipped silently.
#pragma once

#include <string>

#include "core/scene.h"

namespace lanewise {

// text: the file's bytes, UTF-8. path is for messages and Scene::path alone. Throws Error "PATH:LINE: ..." for what is
// broken: bad XML, references, numbers, counts, indices, transforms, values out of range, cycles, unknown CGL
// materials. Linear in the text's length and the triangles that it instances (at most 2^26).
Scene load_collada(const std::string& path, const std::string& text);

}  // namespace lanewise
