// A furnace whose answer is known for every number of bounces: a diffuse sphere with a small glowing one at its centre,
// seen from inside.
#pragma once

#include <cmath>

#include "core/scene.h"

namespace lanewise::test {

constexpr double kCavityShare = 0.01;  // of what leaves the wall in any direction, by Lambert's law, meets the light

// The wall has this albedo and radius 1, the light radiance 1 and radius sqrt(kCavityShare) (reciprocity of the form
// factors); the camera, near the wall, sees nothing but the wall.
inline Scene cavity(double albedo) {
  Scene scene;
  scene.path = "cavity";
  scene.materials.resize(2);
  scene.materials[0].reflectance = glm::dvec3(albedo);
  scene.materials[1].kind = Material::Kind::kEmission;
  scene.materials[1].radiance = glm::dvec3(1);
  scene.spheres = {{"wall", glm::dvec3(0), 1, 0}, {"light", glm::dvec3(0), std::sqrt(kCavityShare), 1}};
  Camera camera;
  camera.to_world[3] = {0.5, 0, 0, 1};
  camera.xfov = 0.5;
  scene.cameras = {camera};
  return scene;
}

// The radiance of the wall by paths of at most max_depth scattering events: by symmetry each adds the share of the light
// at once, or the rest from the wall again.
inline double cavity_radiance(double albedo, uint32_t max_depth) {
  const double again = albedo * (1 - kCavityShare);
  return albedo * kCavityShare * (1 - std::pow(again, max_depth)) / (1 - again);
}

}  // namespace lanewise::test
