#include "core/scene.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/texture.h"
#include "core/types.h"

namespace lanewise {
namespace {

// Far beyond any scene in metres, and far enough below float's range that products of three coordinates stay finite.
constexpr double kMaxCoordinate = 1e15;

// With so many repeats of a texture a float finds no texel any more.
constexpr double kMaxTexcoord = 1e6;

// A triangle whose area is below this share of its longest edge squared has no usable normal in any precision.
constexpr double kFlatRatio = 1e-14;

using Corners = std::array<glm::dvec3, 3>;

// positions: dvec3 or vec3.
template <class Vec>
Corners corners(const std::vector<Vec>& positions, const std::array<uint32_t, 3>& triangle) {
  return {glm::dvec3(positions[triangle[0]]), glm::dvec3(positions[triangle[1]]), glm::dvec3(positions[triangle[2]])};
}

// Twice the area, along the normal of the front.
glm::dvec3 area_vector(const Corners& p) { return glm::cross(p[1] - p[0], p[2] - p[0]); }

bool has_area(const Corners& p) {
  const glm::dvec3 edges[] = {p[1] - p[0], p[2] - p[1], p[0] - p[2]};
  double longest = 0;
  for (const glm::dvec3& e : edges) longest = std::max({longest, std::abs(e.x), std::abs(e.y), std::abs(e.z)});
  if (longest == 0) return false;
  // Relative to the longest edge, so that neither tiny nor huge triangles leave double's range.
  return glm::length(glm::cross(edges[0] / longest, edges[1] / longest)) > 2 * kFlatRatio;
}

bool in_range(const glm::dvec3& p) {
  // Written so that NaN fails.
  return std::abs(p.x) <= kMaxCoordinate && std::abs(p.y) <= kMaxCoordinate && std::abs(p.z) <= kMaxCoordinate;
}

[[noreturn]] void fail(const Scene& scene, const std::string& message) { throw Error(scene.path + ": " + message); }

void check_mesh(const Scene& scene, const Mesh& mesh) {
  const std::string who = "mesh \"" + mesh.name + "\" ";
  if (mesh.material >= scene.materials.size()) fail(scene, who + "names a material that does not exist");
  if (!mesh.normals.empty() && mesh.normals.size() != mesh.triangles.size()) {
    fail(scene, who + "has normals for some triangles only");
  }
  for (const auto& triangle : mesh.triangles) {
    for (const uint32_t index : triangle) {
      if (index >= mesh.positions.size()) {
        fail(scene, who + "has a vertex index out of range: " + std::to_string(index) + " of " +
                        std::to_string(mesh.positions.size()));
      }
      if (!in_range(mesh.positions[index])) {
        fail(scene, who + "has a vertex whose world coordinates are not finite or above 1e15");
      }
    }
  }
}

void check_texcoords(const Scene& scene, const Mesh& mesh) {
  const std::string who = "mesh \"" + mesh.name + "\" ";
  if (!mesh.texcoords.empty() && mesh.texcoords.size() != mesh.triangles.size()) {
    fail(scene, who + "has texture coordinates for some triangles only");
  }
  for (const auto& triangle : mesh.texcoords) {
    for (const glm::dvec2& at : triangle) {
      if (!(std::abs(at.x) <= kMaxTexcoord && std::abs(at.y) <= kMaxTexcoord)) {  // so that NaN fails
        fail(scene, who + "has a texture coordinate that is not finite or above 1e6");
      }
    }
  }
}

void check_sphere(const Scene& scene, const Sphere& sphere) {
  const std::string who = "sphere \"" + sphere.name + "\" ";
  if (sphere.material >= scene.materials.size()) fail(scene, who + "names a material that does not exist");
  if (!in_range(sphere.center)) fail(scene, who + "has a centre that is not finite or above 1e15");
  if (!(static_cast<float>(sphere.radius) > 0 && sphere.radius <= kMaxCoordinate)) {
    fail(scene, who + "has a radius that is not between 0 and 1e15");
  }
}

// Returns how many triangles went. The plan keeps coordinates as floats relative to the centre; an area that does not
// survive that is none. The floats are stored, not converted there and back, which GCC 12 at -O2 leaves out.
size_t drop_flat_triangles(Mesh& mesh, const glm::dvec3& center) {
  std::vector<glm::vec3> rounded;
  rounded.reserve(mesh.positions.size());
  for (const glm::dvec3& p : mesh.positions) rounded.emplace_back(p - center);
  size_t kept = 0;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& triangle = mesh.triangles[i];
    if (!has_area(corners(mesh.positions, triangle)) || !has_area(corners(rounded, triangle))) continue;
    mesh.triangles[kept] = triangle;
    if (!mesh.normals.empty()) mesh.normals[kept] = mesh.normals[i];
    if (!mesh.texcoords.empty()) mesh.texcoords[kept] = mesh.texcoords[i];
    ++kept;
  }
  const size_t dropped = mesh.triangles.size() - kept;
  mesh.triangles.resize(kept);
  if (!mesh.normals.empty()) mesh.normals.resize(kept);
  if (!mesh.texcoords.empty()) mesh.texcoords.resize(kept);
  return dropped;
}

// A material like that one in the mean colour of its texture; the same for all that ask.
uint32_t without_texture(Scene& scene, std::map<uint32_t, uint32_t>& made, uint32_t material) {
  const auto [place, is_new] = made.try_emplace(material, static_cast<uint32_t>(scene.materials.size()));
  if (is_new) {
    Material plain = scene.materials[material];
    plain.reflectance *= mean(scene.textures[plain.texture]);
    plain.texture = kNoTexture;
    scene.materials.push_back(plain);
  }
  return place->second;
}

void settle_textures(Scene& scene) {
  std::map<uint32_t, uint32_t> made;
  const auto is_textured = [&](uint32_t material) { return scene.materials[material].texture != kNoTexture; };
  const auto take_mean = [&](const std::string& who, uint32_t& material) {
    scene.notices.push_back(who + " has a texture and no coordinates in it: rendered in its mean colour");
    material = without_texture(scene, made, material);
  };
  for (Mesh& mesh : scene.meshes) {
    if (!is_textured(mesh.material)) {
      mesh.texcoords = {};
    } else if (mesh.texcoords.empty()) {
      take_mean("mesh \"" + mesh.name + '"', mesh.material);
    }
  }
  for (Sphere& sphere : scene.spheres) {
    if (is_textured(sphere.material)) take_mean("sphere \"" + sphere.name + '"', sphere.material);
  }
}

void smooth_normals(Mesh& mesh) {
  std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
  for (const auto& triangle : mesh.triangles) {
    const glm::dvec3 area = area_vector(corners(mesh.positions, triangle));
    for (const uint32_t index : triangle) sums[index] += area;
  }
  mesh.normals.resize(mesh.triangles.size());
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::dvec3 face = glm::normalize(area_vector(corners(mesh.positions, mesh.triangles[i])));
    for (int c = 0; c < 3; ++c) {
      const glm::dvec3& sum = sums[mesh.triangles[i][c]];
      const double length = glm::length(sum);
      // Faces folded back to back cancel; each then keeps its own normal.
      mesh.normals[i][c] = length > 0 ? sum / length : face;
    }
  }
}

}  // namespace

bool is_rough_glass(const Material& material) {
  constexpr double kLeastAlpha = 1e-4, kLeastContrast = 1e-3;
  return material.kind == Material::Kind::kGlass && material.roughness >= kLeastAlpha &&
         std::abs(material.ior - 1) >= kLeastContrast;
}

size_t Scene::triangle_count() const {
  size_t count = 0;
  for (const Mesh& mesh : meshes) count += mesh.triangles.size();
  return count;
}

Bounds bounds(const Scene& scene) {
  Bounds box;
  for (const Mesh& mesh : scene.meshes) {
    for (const auto& triangle : mesh.triangles) {
      for (const uint32_t index : triangle) box.add(mesh.positions[index]);
    }
  }
  for (const Sphere& sphere : scene.spheres) {
    box.add(sphere.center - sphere.radius);
    box.add(sphere.center + sphere.radius);
  }
  return box;
}

void finish_scene(Scene& scene) {
  for (const Mesh& mesh : scene.meshes) check_mesh(scene, mesh);
  for (const Sphere& sphere : scene.spheres) check_sphere(scene, sphere);
  settle_textures(scene);
  for (const Mesh& mesh : scene.meshes) check_texcoords(scene, mesh);  // of those that a texture needs

  const glm::dvec3 center = bounds(scene).center();
  size_t dropped = 0;
  for (Mesh& mesh : scene.meshes) dropped += drop_flat_triangles(mesh, center);
  std::erase_if(scene.meshes, [](const Mesh& mesh) { return mesh.triangles.empty(); });
  if (dropped > 0) scene.notices.push_back(std::to_string(dropped) + " triangles of zero area dropped");

  if (scene.meshes.empty() && scene.spheres.empty()) fail(scene, "the scene has no geometry");
  if (scene.cameras.empty()) fail(scene, "the scene has no camera");
}

void check_light(const Scene& scene) {
  const auto emits = [&](const auto& shape) {
    const Material& material = scene.materials[shape.material];
    return material.kind == Material::Kind::kEmission && material.radiance != glm::dvec3(0.0);
  };
  if (std::ranges::any_of(scene.meshes, emits) || std::ranges::any_of(scene.spheres, emits)) return;
  if (std::ranges::any_of(scene.environment.rgb, [](float x) { return x > 0; })) return;
  fail(scene, "the scene has no light: no mesh, sphere or area light that emits, no environment map (-e) that does");
}

void apply_normals(Scene& scene, Normals normals) {
  if (normals == Normals::kFile) return;
  for (Mesh& mesh : scene.meshes) {
    if (normals == Normals::kSmooth) {
      smooth_normals(mesh);
    } else {
      mesh.normals.clear();
    }
  }
}

}  // namespace lanewise
