#include "scenes/builtin.h"

#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>

#include "core/types.h"

namespace lanewise {
namespace {

constexpr uint32_t kDefaultTriangles = 200'000;
constexpr uint32_t kMinTriangles = 1'000;
constexpr uint32_t kMaxTriangles = 20'000'000;
constexpr double kTurn = 2 * std::numbers::pi;

// The centre line of a torus knot that winds twice around the z axis and three times around the torus; s in [0, 1).
glm::dvec3 knot(double s) {
  const double around = 2 * kTurn * s;
  const double across = 3 * kTurn * s;
  const double r = 0.5 + 0.2 * std::cos(across);
  return {r * std::cos(around), r * std::sin(around), 0.2 * std::sin(across)};
}

glm::dvec3 knot_surface(double s, double angle) {
  constexpr double kStep = 1e-4;
  const glm::dvec3 before = knot(s - kStep);
  const glm::dvec3 after = knot(s + kStep);
  const glm::dvec3 tangent = glm::normalize(after - before);
  // The line never points away from the axis, so this sum of two of its points spans a frame with the tangent.
  const glm::dvec3 side = glm::normalize(glm::cross(tangent, after + before));
  const glm::dvec3 up = glm::cross(side, tangent);
  const double radius =
      0.11 * (1 + 0.12 * std::sin(4 * angle) * std::sin(60 * kTurn * s) + 0.02 * std::sin(400 * kTurn * s));
  return knot(s) + radius * (std::cos(angle) * side + std::sin(angle) * up);
}

// A closed grid, some eight times as long as it is round, its vertices shared.
Mesh knot_mesh(uint32_t triangles, const glm::dvec3& center) {
  const auto around = static_cast<uint32_t>(std::lround(std::sqrt(triangles / 16.0)));
  const auto along = static_cast<uint32_t>(std::lround(triangles / 2.0 / around));
  Mesh mesh;
  mesh.name = "knot";
  mesh.positions.reserve(size_t{along} * around);
  mesh.triangles.reserve(2 * size_t{along} * around);
  for (uint32_t i = 0; i < along; ++i) {
    for (uint32_t j = 0; j < around; ++j) {
      mesh.positions.push_back(center + knot_surface(double{1} * i / along, kTurn * j / around));
      const uint32_t next_i = (i + 1) % along;
      const uint32_t next_j = (j + 1) % around;
      const uint32_t a = i * around + j;
      const uint32_t b = next_i * around + j;
      const uint32_t c = next_i * around + next_j;
      const uint32_t d = i * around + next_j;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

uint32_t add_diffuse(Scene& scene, const char* name, const glm::dvec3& reflectance) {
  Material material;
  material.name = name;
  material.reflectance = reflectance;
  scene.materials.push_back(material);
  return static_cast<uint32_t>(scene.materials.size() - 1);
}

// The parallelogram corner, corner + a, corner + a + b, corner + b; its front is on the side of a x b.
void add_wall(Scene& scene, const char* name, const glm::dvec3& corner, const glm::dvec3& a, const glm::dvec3& b,
              uint32_t material) {
  Mesh mesh;
  mesh.name = name;
  mesh.positions = {corner, corner + a, corner + a + b, corner + b};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.material = material;
  scene.meshes.push_back(mesh);
}

// A room of 2.8 x 2.4 x 2.1 on the origin, open towards the camera at -y, whose view it fills; a light under the
// ceiling.
void add_cornell_box(Scene& scene) {
  const uint32_t white = add_diffuse(scene, "white", glm::dvec3(0.7));
  const uint32_t red = add_diffuse(scene, "red", {0.6, 0.08, 0.07});
  const uint32_t green = add_diffuse(scene, "green", {0.12, 0.45, 0.15});
  Material lamp;
  lamp.name = "lamp";
  lamp.kind = Material::Kind::kEmission;
  lamp.radiance = glm::dvec3(12, 11, 9);
  scene.materials.push_back(lamp);
  const glm::dvec3 x(2.8, 0, 0), y(0, 2.4, 0), z(0, 0, 2.1), corner(-1.4, -1.2, 0);
  add_wall(scene, "floor", corner, x, y, white);
  add_wall(scene, "ceiling", corner + z, y, x, white);
  add_wall(scene, "back", corner + y, x, z, white);
  add_wall(scene, "left", corner, y, z, red);
  add_wall(scene, "right", corner + x, z, y, green);
  add_wall(scene, "lamp", {-0.45, -0.35, 2.09}, {0, 0.7, 0}, {0.9, 0, 0}, white + 3);

  Camera camera;
  camera.name = "camera";
  camera.to_world = glm::dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 0, 1, 0), glm::dvec4(0, -1, 0, 0),
                               glm::dvec4(0, -5.15, 1.05, 1));
  camera.xfov = 40 * std::numbers::pi / 180;
  scene.cameras.push_back(camera);
}

Scene dense(uint32_t triangles) {
  Scene scene;
  Material gold;
  gold.name = "gold";
  gold.kind = Material::Kind::kMicrofacet;
  gold.alpha = 0.2;
  gold.eta = {0.21646, 0.42833, 1.3284};
  gold.k = {3.2390, 2.4599, 1.8661};
  scene.materials.push_back(gold);
  scene.meshes.push_back(knot_mesh(triangles, {0, 0, 0.95}));
  apply_normals(scene, Normals::kSmooth);
  add_cornell_box(scene);
  return scene;
}

}  // namespace

Scene load_builtin(const std::string& name) {
  std::string_view rest = std::string_view(name).substr(std::string_view(kBuiltinPrefix).size());
  const std::string_view kind = rest.substr(0, rest.find(':'));
  if (kind != "dense")
    throw Error(name + ": no such built-in scene; there is builtin:dense and builtin:dense:TRIANGLES");
  rest.remove_prefix(kind.size());
  uint32_t triangles = kDefaultTriangles;
  if (!rest.empty()) {
    const auto [p, error] = std::from_chars(rest.data() + 1, rest.data() + rest.size(), triangles);
    const bool whole = error == std::errc() && p == rest.data() + rest.size();
    if (!whole || triangles < kMinTriangles || triangles > kMaxTriangles) {
      throw Error(name + ": the number of triangles must be between 1,000 and 20,000,000");
    }
  }
  Scene scene = dense(triangles);
  scene.path = name;
  finish_scene(scene);
  return scene;
}

}  // namespace lanewise
