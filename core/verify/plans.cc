#include "core/verify/plans.h"

#include <cmath>
#include <random>
#include <string>

#include "core/scene.h"
#include "core/verify/test_scene.h"

namespace lanewise::verify {
namespace {

// Puts another small sphere of a new material at the back of the box, 17 in a row; the seventeenth sphere makes them a tree.
void add_sample(Scene& scene, const Material& material) {
  const double i = static_cast<double>(scene.spheres.size()), row = std::floor(i / 17);
  scene.spheres.push_back({material.name,
                           {-0.9 + 0.11 * (i - 17 * row), 0.8 - 0.12 * row, 0.2 + 0.05 * std::fmod(7 * i, 5)},
                           0.05,
                           static_cast<uint32_t>(scene.materials.size())});
  scene.materials.push_back(material);
}

Scene rich_scene() {
  Scene scene = test::test_scene();
  for (const double alpha : {1e-4, 1e-3, 0.01, 0.05, 0.5, 1.0}) {
    Material metal = scene.materials[test::kGold];
    metal.alpha = alpha;
    add_sample(scene, metal);
  }
  Material chromium = scene.materials[test::kGold];
  chromium.eta = {3.1743, 3.18, 2.465};
  chromium.k = {3.3, 3.33, 3.215};
  add_sample(scene, chromium);
  for (const double ior : {0.67, 1.0001, 1.1, 1.333, 1.5, 2.5}) {
    Material glass = scene.materials[test::kGlassMaterial];
    glass.ior = ior;
    glass.reflectance = {1, 0.9, 0.8};
    glass.transmittance = {0.8, 0.9, 1};
    add_sample(scene, glass);
  }
  for (const double ior : {0.67, 1.01, 1.5, 2.5}) {
    for (const double roughness : {1e-3, 0.05, 0.3, 1.0}) {
      Material glass = scene.materials[test::kGlassMaterial];
      glass.ior = ior;
      glass.roughness = roughness;
      glass.reflectance = {1, 0.9, 0.8};
      glass.transmittance = {0.8, 0.9, 1};
      add_sample(scene, glass);
    }
  }
  for (int i = 0; i < 3; ++i) add_sample(scene, scene.materials[i == 1 ? test::kSmallLight : test::kMirrorMaterial]);
  // A light of many triangles of different sizes.
  Mesh fan = scene.meshes[5];
  fan.positions = {{0, 0, 1.45}, {0.4, 0, 1.4}, {0.3, 0.3, 1.4}, {0, 0.2, 1.4}, {-0.5, 0.4, 1.4}, {-0.2, -0.3, 1.4}};
  fan.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 4, 3}, {0, 5, 4}, {0, 1, 5}};
  scene.meshes.push_back(fan);
  return scene;
}

// Spheres and red walls stay without.
void hang_texture(Scene& scene) {
  std::mt19937 rng(5);
  Texture texture{"test", 7, 5, {}};
  for (uint32_t i = 0; i < 35; ++i) texture.texels.push_back(static_cast<uint32_t>(rng()) & 0xffffff);
  scene.textures.push_back(texture);
  for (Mesh& mesh : scene.meshes) {
    if (mesh.material != test::kWhite && mesh.material != test::kBlue) continue;
    scene.materials[mesh.material].texture = 0;
    mesh.texcoords = {{{{0, 0}, {1, 0}, {1, 1}}}, {{{0, 0}, {1, 1}, {0, 1}}}};
    if (mesh.name == "floor") mesh.texcoords = {{{{-3, 1}, {2, 4}, {-1, 9}}}, {{{-3, 1}, {-1, 9}, {-6, 6}}}};
  }
}

Scene flat_scene() {
  Scene scene = test::test_box();
  hang_texture(scene);
  scene.spheres.push_back({"lamp", {0.6, 0.4, 1.1}, 0.1, test::kSmallLight});
  return scene;
}

}  // namespace

std::vector<Plan> verification_plans() {
  Settings lens;
  lens.lens_radius = 0.1, lens.focal_distance = 3;
  return {make_plan(rich_scene(), {}), make_plan(flat_scene(), lens), make_plan(test::test_outdoors(), {})};
}

std::vector<Settings> verification_settings() {
  std::vector<Settings> all;
  for (const Direct direct : {Direct::kMis, Direct::kLight, Direct::kBsdf, Direct::kHemisphere}) {
    for (const BsdfSampling sampling : {BsdfSampling::kVndf, BsdfSampling::kNdf, BsdfSampling::kCosine}) {
      for (const Fresnel fresnel : {Fresnel::kExact, Fresnel::kSchlick, Fresnel::kCourse}) {
        Settings settings;
        settings.direct = direct;
        settings.bsdf_sampling = sampling;
        settings.fresnel = fresnel;
        settings.light_samples = 2;
        all.push_back(settings);
      }
    }
  }
  return all;
}

}  // namespace lanewise::verify
