// A small scene in memory with one of everything.
#pragma once

#include "core/scene.h"

namespace lanewise::test {

// The index of each material in test_scene().
enum TestMaterial : uint32_t {
  kWhite,
  kRed,
  kBlue,
  kMirrorMaterial,
  kGlassMaterial,
  kGold,
  kCeilingLight,
  kSmallLight
};

// A Cornell box, x in [-1, 1], y in [-1, 1], z in [0, 1.5], open towards -y where the camera stands, with a mirror
// sphere, a glass sphere, a gold sphere, a red tessellated sphere with smooth normals (in the plan's tree), a quad
// light (one parallelogram) and a triangular light.
Scene test_scene();

// A map of the sky, 24 x 12 texels: brighter towards the horizon, black below but for some light from the ground, and a sun of
// one texel, white, in column 5 of row 3.
Image test_sky();

// The box without its mesh, ceiling and large light, under that sky.
Scene test_outdoors();

// The same box with the mesh replaced by nothing: walls and spheres only.
Scene test_box();

}  // namespace lanewise::test
