// What a scene holds, and what of it will likely not render as its author means.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene.h"

namespace lanewise {

struct MaterialUse {
  size_t triangles = 0, spheres = 0;
};

// An emissive mesh or sphere.
struct LightFacts {
  std::string name;
  glm::dvec3 radiance;  // W / (m^2 sr)
  double area;          // m^2, where the scene's unit is the metre
  glm::dvec3 power;     // W: pi radiance area
};

std::vector<MaterialUse> material_uses(const Scene& scene);  // one for each of Scene::materials
std::vector<LightFacts> light_facts(const Scene& scene);

// A line each: no light; emitters with nothing in front of them; glass that is not closed, where more or fewer than two
// faces share an edge or disagree on what is outside; triangles that others cover exactly; diffuse surfaces that absorb
// nothing; cameras that have the whole scene behind them. Linear in the triangles but for sorting.
std::vector<std::string> scene_warnings(const Scene& scene);

}  // namespace lanewise
