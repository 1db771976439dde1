// The scenes that come with the project, and the course's where they are at hand.
#include <cmath>
#include <map>
#include <utility>

#include "tests/scene_paths.h"
#include "tests/scenes_harness.h"

namespace lanewise {
namespace {

using glm::dvec3;

Scene shipped(const char* name) { return load_scene(test::shipped_scene(name).string()); }

size_t emissive_triangles(const Scene& scene) {
  size_t count = 0;
  for (const Mesh& mesh : scene.meshes) {
    if (scene.materials[mesh.material].kind == Material::Kind::kEmission) count += mesh.triangles.size();
  }
  return count;
}

// Six times the volume if the mesh is closed and its front outside.
double signed_volume(const Mesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += glm::dot(mesh.positions[a], glm::cross(mesh.positions[b], mesh.positions[c]));
  }
  return sum;
}

bool is_closed(const Mesh& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (const auto& [a, b, c] : mesh.triangles) {
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      ++edges[{from, to}];
      --edges[{to, from}];
    }
  }
  for (const auto& [edge, balance] : edges) {
    if (balance != 0) return false;
  }
  return true;
}

// Every wall's front faces the room's middle, and the camera sees the middle.
void check_room(const Scene& scene) {
  const dvec3 middle(0, 0, 1.05);
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.triangles.size() != 2) continue;
    CAPTURE(mesh.name);
    for (const auto& [a, b, c] : mesh.triangles) {
      const dvec3 p = mesh.positions[a];
      CHECK(glm::dot(glm::cross(mesh.positions[b] - p, mesh.positions[c] - p), middle - p) > 0);
    }
  }
  REQUIRE(scene.cameras.size() == 1);
  const Camera& camera = scene.cameras[0];
  const dvec3 eye(camera.to_world[3]);
  CHECK(glm::length(glm::normalize(middle - eye) + dvec3(camera.to_world[2])) < 1e-12);
  CHECK(camera.aspect == doctest::Approx(4.0 / 3));
  CHECK(scene.notices.empty());
}

TEST_CASE("shipped scenes: boxes with spheres") {
  const Scene spheres = shipped("cornell_spheres.dae");
  CHECK(spheres.triangle_count() == 12);
  REQUIRE(spheres.spheres.size() == 2);
  CHECK(spheres.materials[spheres.spheres[0].material].kind == Material::Kind::kMirror);
  CHECK(spheres.materials[spheres.spheres[1].material].kind == Material::Kind::kGlass);
  check_room(spheres);
  const Scene metal = shipped("cornell_metal.dae");
  CHECK(metal.triangle_count() == 12);
  REQUIRE(metal.spheres.size() == 2);
  for (const Sphere& sphere : metal.spheres) {
    CHECK(metal.materials[sphere.material].kind == Material::Kind::kMicrofacet);
    CHECK(sphere.center.z == sphere.radius);
  }
  check_room(metal);
  const Scene frosted = shipped("cornell_frosted.dae");
  REQUIRE(frosted.textures.size() == 1);
  CHECK(frosted.textures[0].texels.size() == 192 * 128);
  CHECK(frosted.materials[frosted.meshes[0].material].texture == 0);
  CHECK(frosted.meshes[0].texcoords[0][2] == glm::dvec2(2, 2.5));
  REQUIRE(frosted.spheres.size() == 2);
  CHECK(is_rough_glass(frosted.materials[frosted.spheres[1].material]));
  check_room(frosted);
}

TEST_CASE("shipped scenes: the furnace is a closed box that emits inwards, with camera and sphere in it") {
  const Scene scene = shipped("furnace.dae");
  REQUIRE(scene.meshes.size() == 1);
  CHECK(emissive_triangles(scene) == 12);
  CHECK(is_closed(scene.meshes[0]));
  CHECK(signed_volume(scene.meshes[0]) == doctest::Approx(-6 * 4 * 6 * 4));
  REQUIRE(scene.spheres.size() == 1);
  CHECK(scene.materials[scene.spheres[0].material].reflectance == dvec3(0.75, 0.5, 0.25));
  CHECK(dvec3(scene.cameras.at(0).to_world[3]) == dvec3(0, -3.5, 0));
}

TEST_CASE("built-in scenes: the dense mesh") {
  const Scene scene = load_scene("builtin:dense");
  CHECK(scene.triangle_count() > 100'000);
  CHECK(scene.triangle_count() == doctest::Approx(200'012).epsilon(0.01));
  check_room(scene);
  const Mesh& knot = scene.meshes[0];
  CHECK(is_closed(knot));
  CHECK(signed_volume(knot) > 0);
  size_t against = 0;
  for (size_t i = 0; i < knot.triangles.size(); ++i) {
    const auto& [a, b, c] = knot.triangles[i];
    const dvec3 face = glm::cross(knot.positions[b] - knot.positions[a], knot.positions[c] - knot.positions[a]);
    for (const dvec3& n : knot.normals[i]) against += !(glm::dot(n, face) > 0 && std::abs(glm::length(n) - 1) < 1e-12);
  }
  CHECK(against == 0);
  const Bounds box = bounds(scene);
  for (const dvec3& p : knot.positions) {
    const bool inside = glm::all(glm::lessThan(box.lo, p)) && glm::all(glm::lessThan(p, box.hi));
    if (!inside) FAIL("the knot leaves the box");
  }
  CHECK(load_scene("builtin:dense:5000").triangle_count() == doctest::Approx(5000).epsilon(0.05));
  for (const char* bad : {"builtin:", "builtin:sparse", "builtin:dense:", "builtin:dense:999", "builtin:dense:20000001",
                          "builtin:dense:1e6", "builtin:dense:-1", "builtin:densest"}) {
    CHECK_THROWS_AS(load_scene(bad), Error);
  }
}

TEST_CASE("course scenes, where they are at hand") {
  const std::filesystem::path scenes = test::course_scenes();
  if (!std::filesystem::is_directory(scenes)) return;
  struct Expected {
    const char* name;
    size_t triangles;
    size_t spheres;
  };
  for (const Expected& expected :
       {Expected{"CBempty.dae", 12, 0}, Expected{"CBspheres.dae", 12, 2}, Expected{"CBspheres_lambertian.dae", 12, 2},
        Expected{"CBspheres_microfacet_al_ag.dae", 12, 2}, Expected{"CBbunny.dae", 28'588, 0},
        Expected{"CBbunny_glass.dae", 28'588, 0}, Expected{"CBbunny_microfacet_cu.dae", 28'588, 0},
        Expected{"CBdragon_microfacet_au.dae", 202'532, 0}}) {
    CAPTURE(expected.name);
    if (!std::filesystem::exists(scenes / expected.name)) continue;
    const Scene scene = load_scene((scenes / expected.name).string());
    CHECK(scene.triangle_count() == expected.triangles);
    CHECK(scene.spheres.size() == expected.spheres);
    CHECK(scene.cameras.size() == 1);
    CHECK(emissive_triangles(scene) == 2);
    const bool has_area_light = expected.name != std::string("CBempty.dae");
    CHECK(has_notice(scene, "overlaps the emissive mesh \"light\"") == has_area_light);
    const Bounds box = bounds(scene);
    CHECK(glm::length(box.lo - dvec3(-1, -1, 0)) < 0.01);
    CHECK(glm::length(box.hi - dvec3(1, 1, 1.5)) < 0.01);
  }
}

}  // namespace
}  // namespace lanewise
