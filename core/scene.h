// What a loader makes of a file: authoring data in double precision and world space. The plan is compiled from it.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/texture.h"

namespace lanewise {

constexpr uint32_t kNoTexture = ~0u;

// Linear RGB values; unused members keep their defaults.
struct Material {
  enum class Kind { kDiffuse, kMirror, kGlass, kMicrofacet, kEmission };

  std::string name;
  Kind kind = Kind::kDiffuse;
  glm::dvec3 reflectance{0.0};    // diffuse albedo; mirror and glass: tint of reflection; each in [0, 1]
  uint32_t texture = kNoTexture;  // diffuse: index into Scene::textures, whose colour reflectance multiplies
  glm::dvec3 transmittance{1.0};  // glass: tint of refraction, in [0, 1]
  double ior = 1.5;               // glass: index inside over index outside, > 0
  double roughness = 0;           // glass: Beckmann's alpha, from 0 on; see is_rough_glass
  double alpha = 0.1;             // microfacet: Beckmann roughness, RMS slope times sqrt(2), in (0, 1] or above
  glm::dvec3 eta{1.0};            // microfacet: real index at 614, 549, 466 nm
  glm::dvec3 k{0.0};              // microfacet: extinction coefficient
  glm::dvec3 radiance{0.0};       // emission: W / (m^2 sr), from the front (the side that sees the winding turn left)
};

// Whether glass is rougher than a float's direction, and refracts: with an index of 1 its roughness does nothing.
bool is_rough_glass(const Material& material);

struct Mesh {
  std::string name;
  std::vector<glm::dvec3> positions;               // world space
  std::vector<std::array<uint32_t, 3>> triangles;  // indices into positions, counter-clockwise seen from the front
  std::vector<std::array<glm::dvec3, 3>>
      normals;  // the file's unit normals at each triangle's corners; empty: it has none
  std::vector<std::array<glm::dvec2, 3>>
      texcoords;  // where in a texture each triangle's corners are: (0, 0) its lower left, (1, 1) its upper right, repeated
                  // beyond; empty: it has none
  uint32_t material = 0;
};

struct Sphere {
  std::string name;
  glm::dvec3 center{0.0};
  double radius = 1.0;  // > 0
  uint32_t material = 0;
};

// A perspective camera at the origin of its own frame, looking along -z with y up.
struct Camera {
  std::string name;
  glm::dmat4 to_world{1.0};
  double xfov = 0.8;          // full horizontal field of view in radians, in (0, pi)
  double aspect = 4.0 / 3.0;  // width / height of the view that xfov describes
};

struct Scene {
  std::string path;  // where it was read from, for messages
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Mesh> meshes;
  std::vector<Sphere> spheres;
  std::vector<Camera> cameras;
  Image environment;                 // the radiance around it: core/environment_map.h says where; of no size: black
  glm::dvec3 up{0, 0, 1};            // the axis of what needs one that the file does not give: unit
  std::vector<std::string> notices;  // what the loader decided and a user may want to know, a line each

  size_t triangle_count() const;
};

struct Bounds {
  glm::dvec3 lo{1e300}, hi{-1e300};

  void add(const glm::dvec3& p) {
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
  glm::dvec3 center() const { return lo + 0.5 * (hi - lo); }
  double diagonal() const { return glm::length(hi - lo); }
};

// Box of all meshes and spheres.
Bounds bounds(const Scene& scene);

// The last step of every loader: drops zero-area triangles (with a notice that counts them) and meshes left empty, and
// throws Error, naming scene.path, for what cannot be rendered: no geometry, no camera, coordinates that are not finite
// or above 1e15, indices out of range. What has a texture but no coordinates in it (spheres never have) gets a material of
// its mean colour, with a notice; coordinates that no texture needs are dropped.
void finish_scene(Scene& scene);

// Throws Error, naming scene.path, if nothing in it nor around it emits light.
void check_light(const Scene& scene);

enum class Normals { kFile, kSmooth, kFlat };

// Replaces the normals of all meshes: kFile keeps them, kFlat drops them, kSmooth makes each corner's the area-weighted
// mean of the faces around its vertex (Gouraud's, as the course program does).
void apply_normals(Scene& scene, Normals normals);

}  // namespace lanewise
