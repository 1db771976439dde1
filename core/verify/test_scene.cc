#include "core/verify/test_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lanewise::test {
namespace {

using glm::dvec3;

Material diffuse(const char* name, const dvec3& reflectance) {
  Material m;
  m.name = name;
  m.reflectance = reflectance;
  return m;
}

Material of_kind(const char* name, Material::Kind kind) {
  Material m;
  m.name = name;
  m.kind = kind;
  m.reflectance = dvec3(1);
  return m;
}

// Corners counter-clockwise as seen from the front.
Mesh quad(const char* name, uint32_t material, const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
  Mesh m;
  m.name = name;
  m.material = material;
  m.positions = {a, b, c, d};
  m.triangles = {{0, 1, 2}, {0, 2, 3}};
  return m;
}

Mesh tessellated_sphere(uint32_t material, const dvec3& center, double radius, uint32_t rows) {
  Mesh m;
  m.name = "tessellated";
  m.material = material;
  const uint32_t columns = 2 * rows;
  const auto at = [&](uint32_t row, uint32_t column) {
    const double theta = std::numbers::pi * row / rows, phi = 2 * std::numbers::pi * (column % columns) / columns;
    return dvec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
  };
  for (uint32_t row = 0; row <= rows; ++row) {
    for (uint32_t column = 0; column < columns; ++column) m.positions.push_back(center + radius * at(row, column));
  }
  const auto add = [&](std::array<uint32_t, 3> t) {
    m.triangles.push_back(t);
    m.normals.push_back({glm::normalize(m.positions[t[0]] - center), glm::normalize(m.positions[t[1]] - center),
                         glm::normalize(m.positions[t[2]] - center)});
  };
  for (uint32_t row = 0; row < rows; ++row) {
    for (uint32_t column = 0; column < columns; ++column) {
      const uint32_t next = (column + 1) % columns;
      const uint32_t a = row * columns + column, b = row * columns + next;
      const uint32_t c = a + columns, d = b + columns;
      if (row + 1 < rows) add({a, c, d});
      if (row > 0) add({a, d, b});
    }
  }
  return m;
}

}  // namespace

Scene test_box() {
  Scene scene;
  scene.path = "test scene";
  scene.materials = {diffuse("white", dvec3(0.6)),
                     diffuse("red", {0.6, 0.2, 0.2}),
                     diffuse("blue", {0.2, 0.2, 0.6}),
                     of_kind("mirror", Material::Kind::kMirror),
                     of_kind("glass", Material::Kind::kGlass),
                     of_kind("gold", Material::Kind::kMicrofacet),
                     of_kind("ceiling light", Material::Kind::kEmission),
                     of_kind("small light", Material::Kind::kEmission)};
  scene.materials[kMirrorMaterial].reflectance = {1.0, 0.9, 0.8};
  scene.materials[kGlassMaterial].ior = 1.45;
  scene.materials[kGold].alpha = 0.2;
  scene.materials[kGold].eta = {0.21646, 0.42833, 1.3284};
  scene.materials[kGold].k = {3.2390, 2.4599, 1.8661};
  scene.materials[kCeilingLight].radiance = dvec3(10);
  scene.materials[kSmallLight].radiance = {20, 10, 5};
  scene.meshes = {
      quad("floor", kWhite, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}),
      quad("ceiling", kWhite, {-1, -1, 1.5}, {-1, 1, 1.5}, {1, 1, 1.5}, {1, -1, 1.5}),
      quad("back", kWhite, {-1, 1, 0}, {1, 1, 0}, {1, 1, 1.5}, {-1, 1, 1.5}),
      quad("left", kRed, {-1, -1, 0}, {-1, 1, 0}, {-1, 1, 1.5}, {-1, -1, 1.5}),
      quad("right", kBlue, {1, -1, 0}, {1, -1, 1.5}, {1, 1, 1.5}, {1, 1, 0}),
      quad("light", kCeilingLight, {-0.4, -0.3, 1.49}, {-0.4, 0.3, 1.49}, {0.4, 0.3, 1.49}, {0.4, -0.3, 1.49}),
  };
  Mesh triangle;
  triangle.name = "small light";
  triangle.material = kSmallLight;
  triangle.positions = {{-0.9, 0.9, 1.2}, {-0.6, 0.9, 1.2}, {-0.9, 0.6, 1.3}};
  triangle.triangles = {{0, 1, 2}};
  scene.meshes.push_back(triangle);
  scene.spheres = {{"mirror", {0.4, 0.3, 0.3}, 0.3, kMirrorMaterial},
                   {"glass", {-0.4, -0.3, 0.3}, 0.3, kGlassMaterial},
                   {"gold", {0.5, -0.5, 0.15}, 0.15, kGold}};
  Camera camera;
  camera.to_world[0] = {1, 0, 0, 0};
  camera.to_world[1] = {0, 0, 1, 0};
  camera.to_world[2] = {0, -1, 0, 0};
  camera.to_world[3] = {0, -3.5, 0.75, 1};
  camera.xfov = 0.8;
  scene.cameras = {camera};
  return scene;
}

Image test_sky() {
  Image sky(24, 12);
  for (uint32_t y = 0; y < sky.height; ++y) {
    for (uint32_t x = 0; x < sky.width; ++x) {
      float* rgb = sky.pixel(x, y);
      const float height = 1 - static_cast<float>(y) / 6;
      if (y < 6) rgb[0] = 0.8f - 0.6f * height, rgb[1] = 0.8f - 0.4f * height, rgb[2] = 1;
      if (y >= 10) rgb[0] = 0.2f, rgb[1] = x % 2 == 0 ? 0.1f : 0.15f, rgb[2] = 0.05f;
    }
  }
  std::fill_n(sky.pixel(5, 3), 3, 50.0f);
  return sky;
}

Scene test_outdoors() {
  Scene scene = test_box();
  std::erase_if(scene.meshes, [](const Mesh& mesh) { return mesh.name == "ceiling" || mesh.name == "light"; });
  scene.environment = test_sky();
  return scene;
}

Scene test_scene() {
  Scene scene = test_box();
  scene.meshes.push_back(tessellated_sphere(kRed, {0, 0.5, 0.9}, 0.25, 12));
  return scene;
}

}  // namespace lanewise::test
