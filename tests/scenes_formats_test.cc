// OBJ, PLY and glTF: the same box in each is the same scene as its COLLADA twin; materials, cameras and transforms.
#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "scenes/gltf_material.h"
#include "scenes/load.h"
#include "tests/formats_harness.h"
#include "tests/scenes_harness.h"

namespace lanewise {
namespace {

using glm::dvec3;
using nlohmann::json;
using test::TemporaryFolder;
using Kind = Material::Kind;

const Mesh& mesh_named(const Scene& scene, const std::string& name) {
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.name == name) return mesh;
  }
  FAIL("no mesh " << name);
  return scene.meshes.front();
}

void check_same_material(const Material& a, const Material& b) {
  CHECK(a.kind == b.kind);
  CHECK(a.reflectance == b.reflectance);
  CHECK(a.radiance == b.radiance);
}

// By the corners of its triangles, whose vertices may stand in another order.
void check_same_mesh(const Mesh& a, const Mesh& b) {
  CAPTURE(a.name);
  REQUIRE(a.triangles.size() == b.triangles.size());
  CHECK(a.positions.size() == b.positions.size());
  REQUIRE(a.normals.size() == b.normals.size());
  for (size_t t = 0; t < a.triangles.size(); ++t) {
    for (int c = 0; c < 3; ++c) {
      CHECK(a.positions[a.triangles[t][c]] == b.positions[b.triangles[t][c]]);
      if (!a.normals.empty()) CHECK(a.normals[t][c] == b.normals[t][c]);
    }
  }
}

TEST_CASE("formats: the box of OBJ, glTF and GLB is the COLLADA twin's") {
  const TemporaryFolder folder;
  test::write_boxes(folder);
  const Scene twin = load_scene(folder.file("box.dae"));
  for (const char* name : {"box.obj", "box.gltf", "box.glb"}) {
    CAPTURE(std::string(name));
    const Scene scene = load_scene(folder.file(name));
    CHECK(scene.up == dvec3(0, 1, 0));
    CHECK(scene.meshes.size() == twin.meshes.size());
    for (const Mesh& mesh : twin.meshes) {
      const Mesh& found = mesh_named(scene, mesh.name);
      check_same_mesh(found, mesh);
      check_same_material(scene.materials[found.material], twin.materials[mesh.material]);
    }
    CHECK(has_notice(scene, "no camera") == (std::string(name) == "box.obj"));
  }
}

TEST_CASE("formats: PLY in ascii and binary is the twin's geometry, grey, with a camera that has all in view") {
  const TemporaryFolder folder;
  test::write_boxes(folder);
  const Scene twin = load_scene(folder.file("box.dae"));
  for (const char* name : {"box.ply", "binary.ply"}) {
    CAPTURE(std::string(name));
    const Scene scene = load_scene(folder.file(name));
    REQUIRE(scene.meshes.size() == 1);
    REQUIRE(scene.triangle_count() == 6);
    for (size_t t = 0; t < 6; ++t) {
      const Mesh& mesh = twin.meshes[t / 2];
      for (int c = 0; c < 3; ++c) {
        CHECK(scene.meshes[0].positions[scene.meshes[0].triangles[t][c]] == mesh.positions[mesh.triangles[t % 2][c]]);
      }
    }
    CHECK(scene.meshes[0].normals.empty());
    CHECK(scene.materials[0].kind == Kind::kDiffuse);
    CHECK(scene.materials[0].reflectance == dvec3(0.5));
    CHECK(has_notice(scene, "diffuse grey 0.5"));
    CHECK(has_notice(scene, "no camera"));
    CHECK_THROWS_AS(check_light(scene), Error);
  }
}

TEST_CASE("formats: the default camera sees every corner of the bounds, from the front and above") {
  const TemporaryFolder folder;
  test::write_boxes(folder);
  const Scene scene = load_scene(folder.file("box.ply"));
  const Camera& camera = scene.cameras.at(0);
  const glm::dmat4 to_camera = glm::inverse(camera.to_world);
  const double tan_x = std::tan(camera.xfov / 2), tan_y = tan_x / camera.aspect;
  double nearest = 1;
  for (const dvec3& p : scene.meshes[0].positions) {
    const dvec3 q = dvec3(to_camera * glm::dvec4(p, 1));
    REQUIRE(q.z < 0);
    nearest = std::min(nearest, 1 - std::max(std::abs(q.x) / tan_x, std::abs(q.y) / tan_y) / -q.z);
  }
  CHECK(nearest > 0);
  CHECK(nearest < 0.2);
  CHECK(camera.to_world[2].z > 0.9);
  CHECK(camera.to_world[2].y == doctest::Approx(std::sin(10 * std::numbers::pi / 180)));
}

TEST_CASE("formats: glTF cameras, transforms, instances and mirrorings") {
  const TemporaryFolder folder;
  test::write_boxes(folder);
  const Camera twin = load_scene(folder.file("box.dae")).cameras.at(0);
  json gltf = test::box_gltf();
  Camera camera = load_scene(folder.file("box.gltf")).cameras.at(0);
  CHECK(camera.name == "camera");
  CHECK(camera.xfov == doctest::Approx(twin.xfov).epsilon(1e-12));
  CHECK(camera.aspect == 1.5);
  CHECK(camera.to_world == twin.to_world);

  // A second floor, mirrored and moved, by way of a parent; and a second node with the camera.
  gltf["nodes"].push_back({{"name", "other"}, {"mesh", 0}, {"scale", {-2, 1, 1}}});
  gltf["nodes"].push_back({{"children", {4, 6}}, {"translation", {10, 0, 0}}, {"scale", {2, 2, 2}}});
  gltf["nodes"].push_back(
      {{"name", "far"}, {"camera", 0}, {"rotation", {0, 0.70710678118654752, 0, 0.70710678118654752}}});
  gltf["scenes"][0]["nodes"].push_back(5);
  test::write_text(folder.file("more.gltf"), gltf.dump());
  const Scene scene = load_scene(folder.file("more.gltf"));
  REQUIRE(scene.meshes.size() == 4);
  const Mesh& other = mesh_named(scene, "other");
  CHECK(other.positions[other.triangles[0][0]] == dvec3(14, 0, -2));
  const dvec3 a = other.positions[other.triangles[0][0]], b = other.positions[other.triangles[0][1]],
              c = other.positions[other.triangles[0][2]];
  CHECK(glm::normalize(glm::cross(b - a, c - a)) == dvec3(0, 1, 0));  // its front still faces up
  REQUIRE(scene.cameras.size() == 2);
  CHECK(scene.cameras[1].name == "far");
  CHECK(glm::length(dvec3(scene.cameras[1].to_world[2]) - dvec3(1, 0, 0)) < 1e-6);
  CHECK(glm::length(dvec3(scene.cameras[1].to_world[0])) == doctest::Approx(1));
  CHECK(dvec3(scene.cameras[1].to_world[3]) == dvec3(10, 0, 0));
}

Material gltf_material(const std::string& text, std::vector<std::string>* notices = nullptr) {
  const json parsed = json::parse(text);
  const std::string file = "made.gltf";
  std::vector<std::string> own;
  const auto no_texture = [](const JsonValue&) { return kNoTexture; };
  return read_gltf_material(JsonValue(file, parsed), no_texture, notices ? *notices : own);
}

TEST_CASE("formats: glTF materials") {
  CHECK(gltf_material("{}").kind == Kind::kMicrofacet);  // metallicFactor is 1 by default
  CHECK(gltf_material("{}").alpha == 1);
  const Material metal =
      gltf_material(R"({"pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.5, 0.1, 1], "roughnessFactor": 0.5}})");
  CHECK(metal.kind == Kind::kMicrofacet);
  CHECK(metal.alpha == 0.25);
  const Material glass = gltf_material(
      R"({"pbrMetallicRoughness": {"baseColorFactor": [0.9, 1, 1, 1], "metallicFactor": 0, "roughnessFactor": 0},
      "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.33}}})");
  CHECK(glass.kind == Kind::kGlass);
  CHECK(glass.ior == 1.33);
  CHECK(glass.transmittance == dvec3(0.9, 1, 1));
  CHECK(glass.reflectance == dvec3(1.0));
  CHECK(glass.roughness == 0);
  const Material frosted = gltf_material(
      R"({"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.5},
      "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}})");
  CHECK(frosted.roughness == 0.25);
  const Material light = gltf_material(
      R"({"emissiveFactor": [1, 0.5, 0], "extensions": 
      {"KHR_materials_emissive_strength": {"emissiveStrength": 20}}})");
  CHECK(light.kind == Kind::kEmission);
  CHECK(light.radiance == dvec3(20, 10, 0));
  std::vector<std::string> notices;
  gltf_material(R"({"name": "wood", "normalTexture": {"index": 0}, "pbrMetallicRoughness": {"metallicFactor": 0}})",
                &notices);
  REQUIRE(notices.size() == 1);
  CHECK(notices[0].find("\"wood\" has textures of other things") != std::string::npos);
}

// Unpolarised, from vacuum.
double fresnel(double eta, double k, double cosine) {
  const std::complex<double> n(eta, k), t = std::sqrt(1.0 - (1 - cosine * cosine) / (n * n));
  return (std::norm((cosine - n * t) / (cosine + n * t)) + std::norm((n * cosine - t) / (n * cosine + t))) / 2;
}

TEST_CASE("formats: a metal of a reflectance has it head on, and Schlick's elsewhere to 0.04") {
  for (const double r : {0.0, 0.04, 0.2, 0.5, 0.8, 0.95, 0.998}) {
    CAPTURE(r);
    double eta = 0, k = 0;
    metal_of_reflectance(r, eta, k);
    CHECK(fresnel(eta, k, 1) == doctest::Approx(r).epsilon(1e-9));
    for (double cosine = 0.005; r >= 0.04 && cosine < 1; cosine += 0.01) {
      CHECK(std::abs(fresnel(eta, k, cosine) - (r + (1 - r) * std::pow(1 - cosine, 5))) < 0.04);
    }
  }
  double eta = 0, k = 0;
  metal_of_reflectance(1, eta, k);
  CHECK(eta > 0);
  CHECK(fresnel(eta, k, 1) == doctest::Approx(0.999));
}

Material obj_material(const std::string& mtl, Scene* scene = nullptr) {
  const TemporaryFolder folder;
  test::write_text(folder.file("a.mtl"), "newmtl m\n" + mtl);
  test::write_text(folder.file("a.obj"), "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
  const Scene loaded = load_scene(folder.file("a.obj"));
  if (scene) *scene = loaded;
  return loaded.materials.at(0);
}

TEST_CASE("formats: OBJ materials") {
  CHECK(obj_material("Kd 0.5 0.25 0\n").reflectance == dvec3(0.5, 0.25, 0));
  CHECK(obj_material("Ke 5 0 0\nKd 1 1 1\n").radiance == dvec3(5, 0, 0));
  const Material glass = obj_material("illum 7\nNi 1.25\nTf 1 0.5 1\n");
  CHECK(glass.kind == Kind::kGlass);
  CHECK(glass.ior == 1.25);
  CHECK(glass.transmittance == dvec3(1, 0.5, 1));
  CHECK(obj_material("d 0.25\nNi 1.5\n").kind == Kind::kGlass);
  CHECK(obj_material("illum 5\nKs 1 1 1\n").kind == Kind::kMirror);
  Scene scene;
  CHECK(obj_material("illum 7\n", &scene).ior == 1.5);
  CHECK(has_notice(scene, "without an index"));
  CHECK(obj_material("illum 3\nKs 1 1 1\nKd 1 0 0\n", &scene).kind == Kind::kMirror);
  CHECK(has_notice(scene, "diffuse part is left out"));
  CHECK(obj_material("map_Kd wood.png\nKd 1 1 1\n", &scene).reflectance == dvec3(0.5));
  CHECK(has_notice(scene, "its texture is missing"));
}

}  // namespace
}  // namespace lanewise
