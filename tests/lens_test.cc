// Pictures through a thin lens.
#include <doctest/doctest.h>

#include "core/render.h"
#include "core/scene.h"
#include "core/types.h"
#include "kernels/kernels.h"

namespace lanewise {
namespace {

// Two white cards in the dark, both of the same size in the picture and each covering part of it: the left one 2 away from the
// camera, the right one 4.
Scene two_cards() {
  Scene scene;
  scene.path = "two cards";
  scene.materials.resize(1);
  scene.materials[0].kind = Material::Kind::kEmission;
  scene.materials[0].radiance = glm::dvec3(1);
  for (const double distance : {2.0, 4.0}) {
    Mesh card;
    const double x0 = distance == 2 ? -0.8 : 0.2, y = 0.3;
    for (const glm::dvec2 corner : {glm::dvec2(x0, -y), {x0 + 0.6, -y}, {x0 + 0.6, y}, {x0, y}}) {
      card.positions.push_back({corner.x * distance, corner.y * distance, -distance});
    }
    card.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.meshes.push_back(card);
  }
  scene.cameras.resize(1);
  scene.cameras[0].xfov = 1.570796326795;  // x and y of a pixel's directions at distance 1 run from -1 to 1
  scene.cameras[0].aspect = 1;
  return scene;
}

// How many pixels of columns [begin, end) are neither black nor as bright as the card.
int partly_lit(const Image& image, uint32_t begin, uint32_t end) {
  int n = 0;
  for (uint32_t y = 0; y < image.height; ++y) {
    for (uint32_t x = begin; x < end; ++x) {
      const float value = image.pixel(x, y)[0];
      n += value > 0.001f && value < 0.999f;
    }
  }
  return n;
}

}  // namespace

TEST_CASE("lens: what is in focus is as sharp as by a pinhole, the rest is not") {
  Settings settings;
  settings.width = settings.height = 40;  // the cards' borders are pixels' borders
  settings.spp = 64;
  settings.max_depth = 0;
  const Image pinhole = render(make_plan(two_cards(), settings)).image;
  CHECK(partly_lit(pinhole, 0, 40) == 0);
  settings.lens_radius = 0.2;
  for (const double distance : {2.0, 4.0}) {
    settings.focal_distance = distance;
    const Plan plan = make_plan(two_cards(), settings);
    const Image image = render(plan).image, reference = render_reference<double>(plan).image;
    const int left = partly_lit(image, 0, 20), right = partly_lit(image, 20, 40);
    CHECK((distance == 2 ? left : right) == 0);
    // The other card's border is blurred by 0.2 |1 / 2 - 1 / 4| to either side: one pixel of 1 / 20.
    CHECK((distance == 2 ? right : left) > 60);
    CHECK(partly_lit(reference, 0, 20) == left);
  }
}

TEST_CASE("lens: the margins of quads cover rays from all of it") {
  Settings settings;
  settings.lens_radius = 100;  // further than the cards reach
  const Plan plan = make_plan(two_cards(), settings);
  CHECK(plan.camera.lens_radius == 100);
  REQUIRE(plan.flat_quads.size() == 2);
  for (const FlatQuad& quad : plan.flat_quads) {
    CHECK(quad.reach >= 200);
    CHECK(quad.reach < 220);
  }
}

TEST_CASE("lens: autofocus is at the distance of what is at the centre") {
  Settings settings;
  settings.width = settings.height = 40;
  settings.lens_radius = 0.2;
  settings.autofocus = true;
  Scene scene = two_cards();
  CHECK_THROWS_AS(make_plan(scene, settings), UsageError);  // the cards leave it free
  for (glm::dvec3& p : scene.meshes[1].positions) p.x -= 1.4;
  const Plan plan = make_plan(scene, settings);
  CHECK(plan.settings.focal_distance == doctest::Approx(4).epsilon(1e-6));
  settings.autofocus = false;
  settings.focal_distance = 4;
  CHECK(plan.camera.lens_angle == doctest::Approx(make_plan(scene, settings).camera.lens_angle).epsilon(1e-6));
}

}  // namespace lanewise
