// Scenes written for other renderers.
#pragma once

#include <string>
#include <vector>

#include "core/framing.h"
#include "core/scene.h"
#include "core/settings.h"

namespace lanewise {

// A file of its own that the scene's file refers to.
struct ExportedFile {
  std::string path;  // from the scene file's folder
  std::string bytes;
};

struct ExportedScene {
  std::string text;                 // the scene's file
  std::vector<ExportedFile> files;  // a mesh each, the environment map
  std::vector<std::string> losses;  // what the other renderer will show otherwise, a line each
};

// What the picture shows of the scene: settings' resolution, view, lens, depth and samples. folder: of the meshes'
// files, seen from the scene's own. Scene::meshes' normals are written as they are.
//
// Mitsuba 3 (XML). Everything is exact but for what floats round: box filter, two-sided opaque materials, emitters that
// shine from their front, max_depth one above ours, roulette only where ours is. $samples, $depth and $sampler may be
// set from its command line (-D). In spectral variants colours become spectra, and other than here.
ExportedScene export_mitsuba(const Scene& scene, const Settings& settings, const std::string& folder);

// pbrt-v4. Exact: geometry, camera, lens, box filter, depth, diffuse surfaces, emitters, glass without tints. Not
// exact, and told among the losses: environment maps are left out; pbrt has no Beckmann distribution (its conductors
// are GGX of the same alpha); a mirror is a smooth conductor whose reflectance is right head on only; glass has no
// tints. It renders spectra: eta and k are given at our three wavelengths and are linear between them, constant beyond.
ExportedScene export_pbrt(const Scene& scene, const Settings& settings, const std::string& folder);

// The mesh as a binary little-endian PLY of floats: positions, normals too if it has some and `normals` is set, texture
// coordinates u, v if it has some (v, or 1 - v if `v_down`: some have a texture's first row at v = 0), triangles.
std::string ply_file(const Mesh& mesh, bool normals, bool v_down = false);

// What a textured material reflects, linear, row 0 at the top.
Image albedo_map(const Scene& scene, const Material& material);

// As mesh_path, for a material's texture: "scene_meshes/albedo2.pfm".
std::string albedo_path(const std::string& folder, size_t material);

// "scene.xml" of folder "scene_meshes": "scene_meshes/3.ply".
std::string mesh_path(const std::string& folder, size_t mesh);

// The shortest text that reads back as the same number; three of them with blanks between.
std::string exact(double value);
std::string exact(const glm::dvec3& value);

}  // namespace lanewise
