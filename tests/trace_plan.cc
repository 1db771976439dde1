#include "tests/trace_plan.h"

#include <algorithm>
#include <cmath>

#include "core/plan_trees.h"
#include "core/ray_offset.h"
#include "kernels/kernels.h"
#include "kernels/reference/vec3.h"

namespace lanewise::test {
namespace {

void add_prim(Plan& plan, glm::dvec3 shape, double w, float err) {
  for (int a = 0; a < 3; ++a) plan.prim_shape.push_back(static_cast<float>(shape[a]));
  plan.prim_shape.push_back(static_cast<float>(w));
  plan.prim_err.push_back(err);
  plan.prim_material.push_back(0);
  plan.prim_bin.push_back(kDiffuse);
  plan.prim_light.push_back(0);
}

FlatTriangle add_triangle(Plan& plan, const Triangle& triangle) {
  FlatTriangle flat{};
  for (int k = 0; k < 3; ++k) {
    for (int a = 0; a < 3; ++a) flat.v[k][a] = triangle[static_cast<size_t>(k)][a];
  }
  flat.prim = plan.triangles++;
  const glm::dvec3 v0(triangle[0]),
      n = glm::normalize(glm::cross(glm::dvec3(triangle[1]) - v0, glm::dvec3(triangle[2]) - v0));
  add_prim(plan, n, glm::dot(n, v0), triangle_offset(flat.v));
  return flat;
}

FlatSphere add_ball(Plan& plan, const Ball& ball) {
  FlatSphere flat{{ball.center.x, ball.center.y, ball.center.z}, ball.radius, plan.triangles + plan.spheres++};
  add_prim(plan, ball.center, ball.radius, sphere_offset(flat.center, flat.radius));
  return flat;
}

}  // namespace

Plan trace_plan(const std::vector<Triangle>& triangles, const std::vector<Ball>& balls, Keep keep) {
  Plan plan{};
  for (const Triangle& t : triangles) plan.flat_triangles.push_back(add_triangle(plan, t));
  for (const Ball& b : balls) plan.flat_spheres.push_back(add_ball(plan, b));
  plan.materials.resize(1);
  plan.light_table.assign(4, 0.0f);
  if (keep == Keep::kTrees) {
    plant_triangles(plan, plan.flat_triangles);
    plant_spheres(plan, plan.flat_spheres);
    plan.flat_triangles.clear();
    plan.flat_spheres.clear();
  }
  plan.blocking_triangles = static_cast<uint32_t>(plan.flat_triangles.size());
  return plan;
}

PathBuffer paths_along(const std::vector<Ray>& rays) {
  PathBuffer buffer(static_cast<uint32_t>(rays.size()) + kLanes);
  for (uint32_t i = 0; i < rays.size(); ++i) {
    Path<float> p;
    p.slot = i;
    LANEWISE_SET_VEC3(p, o, rays[i].o);
    LANEWISE_SET_VEC3(p, d, rays[i].d);
    LANEWISE_SET_RGB(p, beta, glm::vec3(1));
    store_path(buffer.state(), i, p);
  }
  return buffer;
}

std::vector<Path<float>> trace(const Plan& plan, const std::vector<Ray>& rays) {
  const PathBuffer buffer = paths_along(rays);
  intersect(plan, buffer.state(), {0, static_cast<uint32_t>(rays.size())});
  std::vector<Path<float>> result;
  for (uint32_t i = 0; i < rays.size(); ++i) result.push_back(load_path<float>(buffer.state(), i));
  return result;
}

glm::vec3 random_point(std::mt19937& rng, float half_side) {
  std::uniform_real_distribution<float> side(-half_side, half_side);
  const float x = side(rng), y = side(rng), z = side(rng);
  return {x, y, z};
}

std::vector<Triangle> random_triangles(std::mt19937& rng, size_t n, float half_side, float size) {
  std::vector<Triangle> result;
  for (size_t i = 0; i < n; ++i) {
    const glm::vec3 at = random_point(rng, half_side);
    const glm::vec3 a = random_point(rng, size), b = random_point(rng, size), c = random_point(rng, size);
    result.push_back({at + a, at + b, at + c});
  }
  return result;
}

std::vector<Triangle> bumpy_ball(uint32_t levels) {
  const float g = 1.618034f;
  const glm::vec3 corners[12] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                                 {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  const int faces[20][3] = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                            {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                            {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  std::vector<Triangle> mesh;
  for (const auto& f : faces) mesh.push_back({corners[f[0]], corners[f[1]], corners[f[2]]});
  for (uint32_t level = 0; level < levels; ++level) {
    std::vector<Triangle> finer;
    for (const Triangle& t : mesh) {
      const glm::vec3 a = 0.5f * (t[0] + t[1]), b = 0.5f * (t[1] + t[2]), c = 0.5f * (t[2] + t[0]);
      finer.insert(finer.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
    }
    mesh = finer;
  }
  // A function of the vertex alone, so that what is shared stays shared.
  for (Triangle& t : mesh) {
    for (glm::vec3& v : t)
      v = glm::normalize(v) * (1 + 0.5f * std::sin(7 * v.x) * std::sin(5 * v.y) * std::cos(6 * v.z));
  }
  return mesh;
}

}  // namespace lanewise::test
