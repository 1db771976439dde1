// What every loader ends with: finish_scene, bounds and apply_normals.
#include <cmath>
#include <limits>

#include "tests/scenes_harness.h"

namespace lanewise {
namespace {

using glm::dvec3;

// An emissive triangle, a camera, and a sphere of radius 1 at the origin.
Scene small_scene() {
  Scene scene;
  scene.path = "made.dae";
  Material light;
  light.kind = Material::Kind::kEmission;
  light.radiance = dvec3(1.0);
  scene.materials = {light, Material()};
  Mesh mesh;
  mesh.name = "m";
  mesh.positions = {{0, 0, 3}, {1, 0, 3}, {0, 1, 3}};
  mesh.triangles = {{0, 1, 2}};
  scene.meshes = {mesh};
  Sphere sphere;
  sphere.name = "s";
  sphere.material = 1;
  scene.spheres = {sphere};
  scene.cameras.emplace_back();
  return scene;
}

// Triangles left of one with these corners.
size_t kept(const dvec3& a, const dvec3& b, const dvec3& c) {
  Scene scene = small_scene();
  Mesh mesh;
  mesh.positions = {a, b, c};
  mesh.triangles = {{0, 1, 2}};
  scene.meshes.push_back(mesh);
  finish_scene(scene);
  CHECK(scene.triangle_count() == scene.meshes.size());
  CHECK(has_notice(scene, "1 triangles of zero area dropped") == (scene.triangle_count() == 1));
  return scene.triangle_count() - 1;
}

std::string finish_error(const Scene& scene) {
  Scene copy = scene;
  try {
    finish_scene(copy);
  } catch (const Error& error) {
    CHECK(std::string(error.what()).starts_with("made.dae: "));
    return error.what();
  }
  return "finished";
}

TEST_CASE("finish_scene drops triangles without area, of any size") {
  CHECK(kept({0, 0, 0}, {1, 0, 0}, {0, 1, 0}) == 1);
  CHECK(kept({0, 0, 0}, {0, 0, 0}, {0, 1, 0}) == 0);
  CHECK(kept({0, 0, 0}, {1, 1, 1}, {2, 2, 2}) == 0);
  CHECK(kept({0.1, 0.1, 0.1}, {0.3, 0.3, 0.3}, {0.7, 0.7, 0.7}) == 0);
  CHECK(kept({1, 1, 1}, {1, 1, 1}, {1, 1, 1}) == 0);
  CHECK(kept({0, 0, 0}, {1e-5, 0, 0}, {0, 1e-5, 0}) == 1);
  CHECK(kept({0, 0, 0}, {1, 0, 0}, {0.5, 1e-6, 0}) == 1);
  CHECK(kept({0, 0, 0}, {1e5, 0, 0}, {0, 1e5, 0}) == 1);
  // Too small beside its distance from the centre for a float to tell its corners apart.
  CHECK(kept({0, 0, 1}, {1e-12, 0, 1}, {0, 1e-12, 1}) == 1);
  CHECK(kept({1, 1, 1}, {1 + 1e-12, 1, 1}, {1, 1 + 1e-12, 1}) == 0);
}

TEST_CASE("finish_scene keeps normals beside their triangles") {
  Scene scene = small_scene();
  scene.meshes[0].triangles = {{0, 0, 1}, {0, 1, 2}};
  scene.meshes[0].normals = {{dvec3(1, 0, 0), dvec3(1, 0, 0), dvec3(1, 0, 0)},
                             {dvec3(0, 1, 0), dvec3(0, 1, 0), dvec3(0, 1, 0)}};
  finish_scene(scene);
  REQUIRE(scene.meshes[0].normals.size() == 1);
  CHECK(scene.meshes[0].normals[0][0] == dvec3(0, 1, 0));
}

TEST_CASE("finish_scene refuses what cannot be rendered") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  CHECK(finish_error(small_scene()) == "finished");
  Scene scene = small_scene();
  scene.cameras.clear();
  CHECK(finish_error(scene) == "made.dae: the scene has no camera");
  scene = small_scene();
  scene.meshes.clear();
  CHECK_THROWS_WITH_AS(check_light(scene), doctest::Contains("made.dae: the scene has no light"), Error);
  scene.spheres[0].material = 0;
  CHECK_NOTHROW(check_light(scene));
  scene.spheres.clear();
  CHECK(finish_error(scene).find("no geometry") != std::string::npos);
  for (const double bad : {nan, inf, -inf, 1e16, -1e300}) {
    scene = small_scene();
    scene.meshes[0].positions[2].y = bad;
    CHECK(finish_error(scene).find("not finite or above 1e15") != std::string::npos);
    scene = small_scene();
    scene.spheres[0].center.x = bad;
    CHECK(finish_error(scene).find("not finite or above 1e15") != std::string::npos);
  }
  for (const double bad : {nan, inf, 0.0, -1.0, 1e16, 1e-60}) {
    scene = small_scene();
    scene.spheres[0].radius = bad;
    CHECK(finish_error(scene).find("radius") != std::string::npos);
  }
  scene = small_scene();
  scene.meshes[0].triangles[0][1] = 3;
  CHECK(finish_error(scene).find("vertex index out of range: 3 of 3") != std::string::npos);
  scene = small_scene();
  scene.meshes[0].material = 2;
  CHECK(finish_error(scene).find("material") != std::string::npos);
  scene = small_scene();
  scene.meshes[0].normals.resize(2);
  CHECK(finish_error(scene).find("normals") != std::string::npos);
}

TEST_CASE("bounds hold used vertices and whole spheres") {
  Scene scene = small_scene();
  scene.meshes[0].positions.push_back({100, 100, 100});
  const Bounds box = bounds(scene);
  CHECK(box.lo == dvec3(-1, -1, -1));
  CHECK(box.hi == dvec3(1, 1, 3));
  CHECK(box.center() == dvec3(0, 0, 1));
  CHECK(box.diagonal() == doctest::Approx(std::sqrt(24.0)));
}

TEST_CASE("apply_normals") {
  Scene scene = small_scene();
  Mesh& mesh = scene.meshes[0];
  // Two triangles of areas 1/2 and 1 with a common edge and a right angle between them; a third alone.
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 2}, {5, 5, 5}, {6, 5, 5}, {5, 6, 5}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}};
  apply_normals(scene, Normals::kFile);
  CHECK(mesh.normals.empty());
  apply_normals(scene, Normals::kSmooth);
  const dvec3 shared = glm::normalize(dvec3(2, 0, 1));
  CHECK(glm::length(mesh.normals[0][0] - shared) < 1e-15);
  CHECK(mesh.normals[0][1] == dvec3(0, 0, 1));
  CHECK(glm::length(mesh.normals[1][1] - shared) < 1e-15);
  CHECK(mesh.normals[1][2] == dvec3(1, 0, 0));
  CHECK(mesh.normals[2][0] == dvec3(0, 0, -1));
  apply_normals(scene, Normals::kFile);
  CHECK(mesh.normals.size() == 3);
  // Back to back: the sum is zero, each keeps its own.
  mesh.triangles = {{0, 1, 2}, {0, 2, 1}};
  apply_normals(scene, Normals::kSmooth);
  CHECK(mesh.normals[0][0] == dvec3(0, 0, 1));
  CHECK(mesh.normals[1][0] == dvec3(0, 0, -1));
  apply_normals(scene, Normals::kFlat);
  CHECK(mesh.normals.empty());
}

}  // namespace
}  // namespace lanewise
