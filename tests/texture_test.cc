// Textures on diffuse surfaces: where each point of a face finds its texel, and what a render makes of it.
#include "core/texture.h"

#include <doctest/doctest.h>

#include <cmath>

#include "core/render.h"
#include "core/srgb.h"
#include "core/verify/plans.h"
#include "core/verify/test_scene.h"
#include "kernels/reference/texture.h"
#include "tests/kernel_harness.h"

namespace lanewise {
namespace {

using glm::dvec2;
using glm::dvec3;
using reference::Vec3;

constexpr uint32_t kRedTexel = 0x0000ff, kGreenTexel = 0x00ff00, kBlueTexel = 0xff0000, kWhiteTexel = 0xffffff;

// Upper row red, green, blue, white; lower row greys.
Texture four_by_two() {
  return {"test", 4, 2, {kRedTexel, kGreenTexel, kBlueTexel, kWhiteTexel, 0x101010, 0x404040, 0x808080, 0xc0c0c0}};
}

constexpr size_t kBack = 2;  // of the box's meshes: x in [-1, 1], z in [0, 1.5], at y = 1

Scene textured_box(const Texture& texture, const dvec2& lo, const dvec2& hi) {
  Scene scene = test::test_box();
  scene.materials.push_back(scene.materials[test::kWhite]);
  scene.materials.back().reflectance = dvec3(0.5, 1, 1);
  scene.materials.back().texture = 0;
  scene.textures = {texture};
  Mesh& back = scene.meshes[kBack];
  back.material = static_cast<uint32_t>(scene.materials.size() - 1);
  back.texcoords = {{{lo, {hi.x, lo.y}, hi}}, {{lo, hi, {lo.x, hi.y}}}};
  return scene;
}

// The albedo at a point of the back wall, by the twin in double precision.
dvec3 albedo(const Plan& plan, double x, double z) {
  Path<double> p;
  p.prim = 2 * kBack;
  p.o_x = x - plan.center[0], p.o_y = 1 - plan.center[1], p.o_z = z - plan.center[2];
  reference::texture(plan, p);
  return {p.a_r, p.a_g, p.a_b};
}

void check_near(const dvec3& a, const dvec3& b) {
  for (int c = 0; c < 3; ++c) CHECK(a[c] == doctest::Approx(b[c]).epsilon(1e-5));
}

}  // namespace

TEST_CASE("texture: SIMD against its twin, also far off the face, on edges between texels and for a texture of one") {
  const std::vector<Plan> plans = verify::verification_plans();
  REQUIRE(!plans[1].textures.empty());
  test::check_kernel(plans[1], "texture");
  const auto far = [](std::mt19937& rng, Path<float>& p) {
    p.o_x *= static_cast<float>(1 + rng() % 1000);
    if (rng() % 4 == 0) p.o_x = p.o_z = 0;
  };
  test::check_kernel(plans[1], "texture", {}, far);
  test::check_kernel(make_plan(textured_box({"one", 1, 1, {0x123456}}, {0, 0}, {1, 1}), {}), "texture");
  test::check_kernel(plans[1], "light_textured");
  test::check_kernel(plans[1], "shade_textured");
}

TEST_CASE("texture: texels lie where their coordinates say, v up, and colours are decoded from sRGB") {
  const Plan plan = make_plan(textured_box(four_by_two(), {0, 0}, {1, 1}), {});
  // Texel centres: columns at u = 1/8, 3/8, ..., the upper row at v = 3/4.
  check_near(albedo(plan, -0.75, 1.125), {0.5, 0, 0});
  check_near(albedo(plan, -0.25, 1.125), {0, 1, 0});
  check_near(albedo(plan, 0.25, 1.125), {0, 0, 1});
  check_near(albedo(plan, 0.75, 1.125), {0.5, 1, 1});
  const double grey = linear_from_srgb(0x40 / 255.0);
  check_near(albedo(plan, -0.25, 0.375), {0.5 * grey, grey, grey});
  // Between two of them a mean; at the edge of the first and the last, which are neighbours.
  check_near(albedo(plan, -0.5, 1.125), {0.25, 0.5, 0});
  check_near(albedo(plan, -1, 1.125), {0.5, 0.5, 0.5});
  const double dark = linear_from_srgb(0x10 / 255.0);
  check_near(albedo(plan, -0.75, 0.75), {0.25 * (1 + dark), 0.5 * dark, 0.5 * dark});
}

TEST_CASE("texture: repeats beyond its edges, either way") {
  const Plan once = make_plan(textured_box(four_by_two(), {0, 0}, {1, 1}), {});
  const Plan often = make_plan(textured_box(four_by_two(), {-2, 3}, {1, 5}), {});
  for (const double x : {-0.9, -0.3, 0.1, 0.77}) {
    for (const double z : {0.1, 0.6, 1.4}) {
      const double u = -2 + 1.5 * (x + 1), v = 3 + 2 * z / 1.5;
      check_near(albedo(often, x, z), albedo(once, 2 * (u - std::floor(u)) - 1, 1.5 * (v - std::floor(v))));
    }
  }
}

TEST_CASE("texture: two triangles are one parallelogram only if their coordinates are") {
  Scene scene = textured_box(four_by_two(), {0, 0}, {1, 1});
  const size_t quads = make_plan(test::test_box(), {}).flat_quads.size();
  CHECK(make_plan(scene, {}).flat_quads.size() == quads);
  scene.meshes[kBack].texcoords[1][2].y = 0.9;
  const Plan plan = make_plan(scene, {});
  CHECK(plan.flat_quads.size() == quads - 1);
  CHECK(plan.flat_triangles.size() == make_plan(test::test_box(), {}).flat_triangles.size() + 2);
}

TEST_CASE("texture: none in the plan where no mesh shows one") {
  Scene scene = textured_box(four_by_two(), {0, 0}, {1, 1});
  scene.meshes[kBack].material = test::kWhite;
  const Plan plan = make_plan(scene, {});
  CHECK(plan.textures.empty());
  CHECK(plan.texels.empty());
  CHECK(plan.prim_texture.empty());
}

TEST_CASE("texture: a white one leaves every bit of a picture, and a grey one is the reflectance that it decodes to") {
  Settings settings;
  settings.width = 40, settings.height = 30, settings.spp = 4, settings.threads = 1;
  const Scene white = textured_box({"white", 1, 1, {kWhiteTexel}}, {0, 0}, {1, 1});
  Scene plain = white;
  plain.materials.back().texture = kNoTexture;
  plain.textures.clear();
  CHECK(render(make_plan(white, settings)).image.rgb == render(make_plan(plain, settings)).image.rgb);

  const Scene grey = textured_box({"grey", 2, 2, {0x808080, 0x808080, 0x808080, 0x808080}}, {0, 0}, {1, 1});
  plain.materials.back().reflectance *= linear_from_srgb(128 / 255.0);
  const Image a = render(make_plan(grey, settings)).image, b = render(make_plan(plain, settings)).image;
  for (size_t i = 0; i < a.rgb.size(); ++i) CHECK(a.rgb[i] == doctest::Approx(b.rgb[i]).epsilon(1e-4));
}

TEST_CASE("texture: SIMD renders what the scalar renderer does") {
  Settings settings;
  settings.width = 40, settings.height = 30, settings.spp = 8, settings.threads = 1;
  const Plan plan = make_plan(textured_box(four_by_two(), {-1, -1}, {3, 2}), settings);
  const Image want = render_reference<float>(plan).image;
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    const Image got = render(plan).image;
    size_t differing = 0;
    for (size_t i = 0; i < want.rgb.size(); ++i) {
      differing += std::abs(got.rgb[i] - want.rgb[i]) > 0.01f * (0.01f + want.rgb[i]);
    }
    CHECK(differing < want.rgb.size() / 50);
  });
}

TEST_CASE("texture: what has no coordinates takes the mean colour, with a notice") {
  Scene scene = textured_box({"two", 2, 1, {0x000000, kWhiteTexel}}, {0, 0}, {1, 1});
  scene.meshes[kBack].texcoords.clear();
  scene.spheres[0].material = scene.meshes[kBack].material;
  scene.meshes[0].texcoords = {{{{NAN, 0}, {}, {}}}};  // not asked for, whatever they are
  finish_scene(scene);
  CHECK(scene.materials[scene.meshes[kBack].material].reflectance == dvec3(0.25, 0.5, 0.5));
  CHECK(scene.meshes[kBack].material == scene.spheres[0].material);
  CHECK(scene.meshes[0].texcoords.empty());
  CHECK(scene.notices.size() == 2);

  Scene broken = textured_box(four_by_two(), {0, 0}, {1, NAN});
  CHECK_THROWS_WITH(finish_scene(broken),
                    "test scene: mesh \"back\" has a texture coordinate that is not finite or above 1e6");
  broken.meshes[kBack].texcoords.pop_back();
  CHECK_THROWS_WITH(finish_scene(broken), "test scene: mesh \"back\" has texture coordinates for some triangles only");
}

}  // namespace lanewise
