// Paths that are used again: squares of pixels, the kernels, where the plan has them, and pictures cut in any way. That they bring
// the light that there is, is in statistics/path_reuse_test.cc.
#include "core/path_reuse.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <string>

#include "core/render.h"
#include "core/scene.h"
#include "core/verify/squares.h"
#include "core/verify/test_scene.h"
#include "tests/kernel_harness.h"

namespace lanewise {
namespace {

Settings small() {
  Settings settings;
  settings.width = 33, settings.height = 25, settings.spp = 8, settings.wave = 256, settings.threads = 2;
  return settings;
}

std::string why_none(const Settings& settings, const Scene& scene = test::test_scene()) {
  return why_no_reuse(make_plan(scene, settings));
}

RenderResult render_with(const Settings& settings) { return render(make_plan(test::test_scene(), settings)); }

// Twice the variance of the picture's values, added up.
double variance(const Scene& scene, Settings settings) {
  const Image one = render(make_plan(scene, settings)).image;
  ++settings.seed;
  const Image other = render(make_plan(scene, settings)).image;
  double sum = 0;
  for (size_t i = 0; i < one.rgb.size(); ++i) sum += std::pow(double(one.rgb[i]) - other.rgb[i], 2);
  return sum;
}

}  // namespace

TEST_CASE("path reuse: every pixel is once in a square, the others of it are there, and none beyond the picture") {
  constexpr uint32_t kWidth = 5, kHeight = 3;
  std::vector<uint32_t> pixels(kWidth * kHeight);
  std::iota(pixels.begin(), pixels.end(), 0u);
  const PixelSquares all = squares_of(pixels, nullptr, kWidth, kHeight);
  CHECK(all.pixels.size() == 3 * 2 * kPathsTogether);
  CHECK(all.pixels == all.slots);
  CHECK(std::ranges::count(all.pixels, kNoPixel) == 24 - 15);
  const std::multiset<uint32_t> once(all.pixels.begin(), all.pixels.end());
  for (const uint32_t pixel : pixels) CHECK(once.count(pixel) == 1);

  // Two pixels of one square, one of another, with sums of their own.
  const std::vector<uint32_t> some = {7, 2, 10}, slots = {0, 1, 2};
  const PixelSquares few = squares_of(some, slots.data(), kWidth, kHeight);
  const uint32_t n = kNoPixel;
  CHECK(few.pixels == std::vector<uint32_t>{2, 3, 7, 8, 10, 11, n, n});
  CHECK(few.slots == std::vector<uint32_t>{1, n, 0, n, 2, n, n, n});
}

TEST_CASE("path reuse: SIMD against the twins, of any number of paths") {
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    for (const uint32_t paths : {4u, 12u, 16u, 20u, 52u, 20000u}) {
      CHECK(verify::keep_first_error(paths, paths) == 0);
      CHECK(verify::keep_second_error(paths, paths) <= kKeepSecondBound.max);
      CHECK(verify::connect_paths_error(paths, paths) <= kConnectPathsBound.max);
      CHECK(verify::share_paths_error(paths, paths) <= kSharePathsBound.max);
    }
  });
}

TEST_CASE("path reuse: where there are diffuse surfaces, and why not elsewhere") {
  CHECK(why_none(small()).empty());
  const auto why = [](const auto& change) {
    Settings settings = small();
    change(settings);
    return why_none(settings);
  };
  CHECK(why([](Settings& s) { s.reuse = false; }) == "--reuse off");
  CHECK(why([](Settings& s) { s.max_depth = 1; }) == "no path of two scattering events");
  CHECK(why([](Settings& s) { s.only_bounce = 1; }) == "no path of two scattering events");
  CHECK(why([](Settings& s) { s.noise = 0.1; }) == "-a and --noise stop pixels one by one");
  CHECK(why([](Settings& s) { s.adaptive_batch = 8; }) == "-a and --noise stop pixels one by one");
  CHECK(why([](Settings& s) { s.direct = Direct::kHemisphere; }) == "--direct hemisphere");
  CHECK(why([](Settings& s) { s.direct = Direct::kLight; }).empty());
  Scene metal = test::test_scene();
  for (Material& material : metal.materials) {
    if (material.kind == Material::Kind::kDiffuse) material = metal.materials[test::kGold];
  }
  CHECK(why_none(small(), metal) == "no flat diffuse surface");
  Scene smooth = test::test_scene();
  smooth.spheres.clear();
  const auto facing = [](double z, uint32_t material) {
    Mesh mesh;
    mesh.material = material;
    mesh.positions = {{-1, -1, z}, {1, -1, z}, {0, 1, z}};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
  };
  smooth.meshes = {facing(0.5, test::kWhite), facing(1, test::kCeilingLight)};
  CHECK(why_none(small(), smooth).empty());
  smooth.meshes[0].normals = {{glm::dvec3(0.6, 0, 0.8), glm::dvec3(0, 0, 1), glm::dvec3(0, 0, 1)}};
  CHECK(why_none(small(), smooth) == "no flat diffuse surface");
}

TEST_CASE("path reuse: the wave's picture is the scalar path tracer's") {
  Settings lens = small();
  lens.lens_radius = 0.05, lens.focal_distance = 3;
  for (const Scene& scene : {test::test_scene(), test::test_box(), test::test_outdoors()}) {
    for (const Settings& settings : {small(), lens}) {
      const Plan plan = make_plan(scene, settings);
      REQUIRE(reuses_paths(plan));
      const RenderResult want = render_reference<float>(plan), got = render(plan);
      size_t differing = 0;
      for (size_t i = 0; i < want.image.rgb.size(); ++i) {
        const float a = got.image.rgb[i], b = want.image.rgb[i];
        differing += std::abs(a - b) > 1e-3f * (std::abs(b) + 0.01f);
      }
      CHECK(double(differing) / double(want.image.rgb.size()) < 0.02);
      CHECK(got.stats.camera_rays == want.stats.camera_rays);
      // Of the sky's light the wave counts also rays from beneath a surface.
      if (!plan.environment.empty()) continue;
      CHECK(double(got.stats.shadow_rays) == doctest::Approx(double(want.stats.shadow_rays)).epsilon(1e-3));
    }
  }
}

TEST_CASE("path reuse: the same bits for any wave, threads and part of the picture, of odd sizes too") {
  const Image whole = render_with(small()).image;
  for (const uint32_t wave : {16u, 48u, 4096u}) {
    Settings settings = small();
    settings.wave = wave, settings.threads = 1;
    CHECK(render_with(settings).image.rgb == whole.rgb);
  }
  for (const Window crop : {Window{0, 0, 16, 16}, {5, 3, 9, 17}, {32, 24, 1, 1}, {1, 0, 31, 25}}) {
    Settings settings = small();
    settings.crop = crop;
    const Image part = render_with(settings).image;
    bool same = true;
    for (uint32_t y = 0; y < crop.height; ++y) {
      for (uint32_t x = 0; x < crop.width; ++x) {
        for (uint32_t c = 0; c < 3; ++c) {
          same &=
              part.rgb[3 * (y * crop.width + x) + c] == whole.rgb[3 * ((crop.y + y) * whole.width + crop.x + x) + c];
        }
      }
    }
    CHECK(same);
  }
}

TEST_CASE("path reuse: light between walls has half the variance or less, and what falls on them directly the same") {
  const Scene scene = test::test_box();
  Settings on = small(), off = small();
  on.only_bounce = off.only_bounce = 2;
  on.light_paths = off.light_paths = false;
  off.reuse = false;
  CHECK(variance(scene, on) < 0.5 * variance(scene, off));
  // Nothing but the walls' own light is shared: of one bounce not a bit is another.
  on.only_bounce = off.only_bounce = 1;
  CHECK(variance(scene, on) == variance(scene, off));
}

TEST_CASE("path reuse: the same for what the camera sees in a mirror") {
  Scene scene = test::test_box();
  scene.spheres.clear();
  // The large lamp turns its back to the ceiling, so that no wall sees a lamp in it, by chance.
  std::erase_if(scene.meshes, [](const Mesh& mesh) { return mesh.name == "small light"; });
  for (Mesh& mesh : scene.meshes) {
    if (mesh.name == "ceiling") mesh.material = test::kMirrorMaterial;
  }
  Settings on = small();
  on.width *= 4, on.height *= 4;
  on.crop = {36, 14, 20, 6};  // of the ceiling alone
  on.only_bounce = 3, on.light_paths = false;
  Settings off = on;
  off.reuse = false;
  CHECK(variance(scene, on) < 0.5 * variance(scene, off));
}

}  // namespace lanewise
