#include "core/plan.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/scene.h"
#include "core/verify/test_scene.h"

namespace lanewise {

TEST_CASE("plan: every primitive is in exactly one list or tree") {
  const Scene scene = test::test_scene();
  const Plan plan = make_plan(scene, {});
  CHECK(plan.triangles == scene.triangle_count());
  CHECK(plan.spheres == 3);
  std::multiset<uint32_t> prims;
  for (const FlatQuad& q : plan.flat_quads) prims.insert({q.prim, q.prim + 1});
  for (const FlatTriangle& t : plan.flat_triangles) prims.insert(t.prim);
  for (const FlatSphere& s : plan.flat_spheres) prims.insert(s.prim);
  for (const TriangleBlock& b : plan.triangle_blocks) {
    const std::set<uint32_t> distinct(b.prim, b.prim + kLeafWidth);  // short blocks repeat their first
    prims.insert(distinct.begin(), distinct.end());
  }
  CHECK(prims.size() == plan.triangles + plan.spheres);
  CHECK(std::set<uint32_t>(prims.begin(), prims.end()).size() == prims.size());
  CHECK(*prims.rbegin() == plan.triangles + plan.spheres - 1);
  CHECK(plan.flat_quads.size() == 6);  // walls and ceiling light
  CHECK(plan.flat_triangles.size() == 1);
  for (const uint32_t m : plan.prim_material) CHECK(m < plan.materials.size());
  for (const uint32_t l : plan.prim_light) CHECK(l < plan.lights.size());
}

TEST_CASE("plan: only what the scene has") {
  Scene scene = test::test_box();
  CHECK(make_plan(scene, {}).shade_stages.size() == 4);
  CHECK(make_plan(scene, {}).prim_normals.empty());
  CHECK(make_plan(test::test_scene(), {}).prim_normals.size() == 9 * make_plan(test::test_scene(), {}).triangles);
  scene.spheres.clear();
  const Plan plan = make_plan(scene, {});
  REQUIRE(plan.shade_stages.size() == 1);
  CHECK(plan.shade_stages[0].bin == kDiffuse);
  CHECK(plan.triangle_tree.nodes.empty());
  CHECK(plan.flat_spheres.empty());
}

TEST_CASE("plan: many spheres go into a tree") {
  Scene scene = test::test_box();
  for (int i = 0; i < 100; ++i) scene.spheres.push_back({"s", {0.01 * i - 0.5, 0, 0.5}, 0.02, test::kRed});
  const Plan plan = make_plan(scene, {});
  CHECK(plan.flat_spheres.empty());
  CHECK(plan.sphere_blocks.size() >= 103 / kLeafWidth);
}

TEST_CASE("plan: a scene far from the origin loses nothing") {
  const Scene near = test::test_scene();
  Scene far = near;
  const glm::dvec3 shift(1e5, -2e5, 3e5);
  for (Mesh& m : far.meshes) {
    for (glm::dvec3& p : m.positions) p += shift;
  }
  for (Sphere& s : far.spheres) s.center += shift;
  far.cameras[0].to_world[3] += glm::dvec4(shift, 0);
  const Plan a = make_plan(near, {}), b = make_plan(far, {});
  for (size_t i = 0; i < a.prim_shape.size(); ++i) CHECK(std::abs(a.prim_shape[i] - b.prim_shape[i]) < 1e-6f);
  for (int k = 0; k < 3; ++k) CHECK(std::abs(a.camera.eye[k] - b.camera.eye[k]) < 1e-6f);
}

TEST_CASE("plan: --view fit stands 1.5 diagonals back and keeps its focal length in pixels") {
  Settings settings;
  settings.view = View::kFit;
  for (const uint32_t scale : {1u, 2u}) {
    settings.width = 480 * scale, settings.height = 360 * scale;
    const Plan plan = make_plan(test::test_scene(), settings);
    const double diagonal = std::sqrt(4 + 4 + 2.25);
    CHECK(plan.camera.eye[1] == doctest::Approx(-1.5 * diagonal));
    CHECK(plan.camera.eye[0] == doctest::Approx(0));
    CHECK(plan.camera.pixel == doctest::Approx(2 * std::tan(0.4) * 0.75 / 600));
  }
}

TEST_CASE("plan: triangle pairs of a light become parallelograms only where they are") {
  Scene scene = test::test_box();
  Mesh& light = scene.meshes[5];
  CHECK(make_plan(scene, {}).lights[0].patches == 1);
  CHECK(make_plan(scene, {}).lights[0].area == doctest::Approx(0.48));
  light.positions[2].x += 0.05;  // a trapezium
  CHECK(make_plan(scene, {}).lights[0].patches == 2);
}

}  // namespace lanewise
