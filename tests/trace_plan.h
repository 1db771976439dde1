// Plans of bare geometry, put into the flat lists or into the trees, for the tests of what traces rays.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <random>
#include <vector>

#include "core/path_buffer.h"
#include "core/plan.h"
#include "core/verify/random_path.h"

namespace lanewise::test {

using Triangle = std::array<glm::vec3, 3>;
struct Ball {
  glm::vec3 center;
  float radius;
};

enum class Keep { kFlat, kTrees };

// Everything is diffuse; primitives are numbered as given, the balls after the triangles.
Plan trace_plan(const std::vector<Triangle>& triangles, const std::vector<Ball>& balls, Keep keep);

struct Ray {
  glm::vec3 o, d;
};

// The state of living paths along the rays, before intersect.
PathBuffer paths_along(const std::vector<Ray>& rays);

// Runs intersect on the rays with the target chosen at the moment.
std::vector<Path<float>> trace(const Plan& plan, const std::vector<Ray>& rays);

glm::vec3 random_point(std::mt19937& rng, float half_side);
std::vector<Triangle> random_triangles(std::mt19937& rng, size_t n, float half_side, float size);

// A closed mesh of 20 * 4^levels triangles around the origin, its vertices exactly shared, at distances of 0.5 to 1.5.
std::vector<Triangle> bumpy_ball(uint32_t levels);

}  // namespace lanewise::test
