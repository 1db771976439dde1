// Light paths: their kernels, where the plan has them, and their film. That they bring what paths from the camera would is in
// statistics/light_paths_test.cc.
#include "core/plan_light_paths.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <random>
#include <string>
#include <thread>

#include "core/light_film.h"
#include "core/render.h"
#include "core/scene.h"
#include "core/verify/test_scene.h"
#include "tests/kernel_harness.h"

namespace lanewise {
namespace {

Settings small() {
  Settings settings;
  settings.width = 32, settings.height = 24, settings.spp = 8, settings.wave = 256, settings.threads = 2;
  return settings;
}

std::string why_none(const Settings& settings, const Scene& scene = test::test_scene()) {
  const Plan plan = make_plan(scene, settings);
  CHECK(has_light_paths(plan) == std::string(why_no_light_paths(plan)).empty());
  return why_no_light_paths(plan);
}

// The cover of directions towards two casters in one place, as light paths have it, on average over them: 2 wherever they are.
double mean_cover(double distance) {
  Scene scene = test::test_box();
  scene.spheres = {{"a", {0, 0, 0.75}, 0.3, test::kMirrorMaterial}, {"b", {0, 0, 0.75}, 0.3, test::kMirrorMaterial}};
  Plan plan = make_plan(scene, small());
  plan.casters = {{{0, 0, static_cast<float>(-distance)}, 0.3f}, {{0, 0, static_cast<float>(-distance)}, 0.3f}};
  plan.lamp_paths = {{1000, 1, 1}};
  constexpr uint32_t kPaths = 4096;
  PathBuffer buffer(kPaths);
  PathState& s = buffer.state();
  s.batch = {.first_path = 0, .paths = kPaths};
  s.step = {.epoch = light_path_epoch(0, 0, 0), .from_light = true};
  emit(plan, s, {0, kPaths});
  double cover = 0;
  for (uint32_t i = 0; i < kPaths; ++i) {
    // beta = throughput (1) * cosine * angle of both cones / cover
    const double sine2 = 0.09 / (distance * distance), height = sine2 / (1 + std::sqrt(1 - sine2));
    const float* n = plan.light_patches[plan.lights[0].first_patch].n;
    const double cosine = double(n[0] * s.d_x[i] + n[1] * s.d_y[i] + n[2] * s.d_z[i]);
    const double beta = double(std::max({s.beta_r[i], s.beta_g[i], s.beta_b[i]}));
    cover += 4 * std::numbers::pi * height * cosine / beta / kPaths;
  }
  return cover;
}

// Of all its lights, so many times as each sends out in a pass.
uint64_t paths_of_pass(const Plan& plan) {
  uint64_t paths = 0;
  for (const LampPaths& lamp : plan.lamp_paths) paths += lamp.per_pass;
  return paths;
}

}  // namespace

TEST_CASE(
    "light paths: SIMD against the twins, from lamps of all kinds, to a pinhole, a lens and a part of the picture") {
  Scene lamp = test::test_scene();
  lamp.spheres[2].material = test::kSmallLight;
  Settings lens = small(), crop = small();
  lens.lens_radius = 0.05, lens.focal_distance = 3;
  crop.crop = {5, 3, 9, 17};
  for (const Scene& scene : {test::test_scene(), test::test_box(), lamp}) {
    for (const Settings& settings : {small(), lens, crop}) {
      const Plan plan = make_plan(scene, settings);
      REQUIRE(has_light_paths(plan));
      for (uint32_t light = 0; light < plan.lights.size(); ++light) {
        test::check_kernel(plan, "emit", {.light = light, .epoch = light_path_epoch(light, 0, 0), .from_light = true});
        test::check_kernel(plan, "connect_camera", {.bounce = 2, .light = light, .from_light = true});
      }
    }
  }
}

TEST_CASE("light paths: who brings a lamp's light, and what normals make of it, as the twins have it") {
  const Plan plan = test::test_plan(small());
  for (const bool leaving : {false, true}) {
    test::check_kernel(plan, "adjoint", {.bounce = 1, .from_light = true, .leaving = leaving});
    for (const bool diffuse : {false, true}) {
      for (const uint32_t bounce : {0u, 1u}) {
        test::check_kernel(plan, "take_lamps", {.bounce = bounce, .diffuse = diffuse, .leaving = leaving});
      }
    }
  }
}

TEST_CASE("light paths: glass does not squeeze the power that they carry") {
  Scene scene = test::test_scene();
  const Plan smooth = make_plan(scene, small());
  test::check_kernel(smooth, "shade_glass", {.bounce = 1, .from_light = true});
  scene.materials[test::kGlassMaterial].roughness = 0.3;
  const Plan rough = make_plan(scene, small());
  test::check_kernel(rough, "shade_rough_glass", {.bounce = 1, .from_light = true});
}

TEST_CASE("light paths: a path changes hands as it should") {
  const Plan plan = make_plan(test::test_box(), small());  // flat: every direction agrees
  const auto after = [&](uint32_t lamps, bool diffuse, uint32_t bounce) {
    PathBuffer buffer(kLanes);
    Path<float> p;
    p.lamps = lamps;
    store_path(buffer.state(), 0, p);
    buffer.state().step = {.bounce = bounce, .diffuse = diffuse};
    take_lamps(plan, buffer.state(), {0, 1});
    return buffer.state().lamps[0];
  };
  CHECK(after(kByItself, true, 0) == kByItselfYet);
  CHECK(after(kByItself, false, 0) == kByItself);
  CHECK(after(kByItselfYet, true, 1) == kByItselfYet);
  CHECK(after(kByItselfYet, false, 1) == kByLightPaths);
  CHECK(after(kByLightPaths, false, 2) == kByLightPaths);
  CHECK(after(kByLightPaths, true, 2) == kByItselfYet);
  CHECK(after(kByItself, true, 1) == kByItself);  // seen in a mirror
  CHECK(after(kByItself, false, 1) == kByItself);
}

TEST_CASE("light paths: directions in two cones count half, however far the casters are") {
  for (const double distance : {10.0, 100.0, 1000.0, 10000.0}) {
    CAPTURE(distance);
    test::for_each_target([&](const char* target) {
      CAPTURE(target);
      CHECK(mean_cover(distance) == doctest::Approx(2).epsilon(3 / distance + 0.01));
    });
  }
}

TEST_CASE("light paths: none where they cannot be, or do not pay") {
  CHECK(why_none(small()) == "");
  const auto with = [](auto change) {
    Settings settings = small();
    change(settings);
    return why_none(settings);
  };
  CHECK(with([](Settings& s) { s.light_paths = false; }) == "--light-paths off");
  CHECK(with([](Settings& s) { s.direct = Direct::kLight; }) != "");
  CHECK(with([](Settings& s) { s.direct = Direct::kHemisphere; }) != "");
  CHECK(with([](Settings& s) { s.adaptive_batch = 8; }) != "");
  CHECK(with([](Settings& s) { s.noise = 0.1; }) != "");
  CHECK(with([](Settings& s) { s.fresnel = Fresnel::kCourse; }) != "");
  CHECK(with([](Settings& s) { s.max_depth = 1; }) != "");
  CHECK(with([](Settings& s) { s.only_bounce = 1; }) != "");
  CHECK(with([](Settings& s) { s.only_bounce = 2; }) == "");

  Scene diffuse = test::test_scene();
  for (Sphere& sphere : diffuse.spheres) sphere.material = test::kWhite;
  CHECK(why_none(small(), diffuse) == "only diffuse surfaces");
  // Close by, the picture shows a thousandth of the floor.
  Scene close = test::test_box();
  close.cameras[0].to_world = glm::dmat4(1.0);
  close.cameras[0].to_world[3] = glm::dvec4(-0.5, -0.5, 0.05, 1);
  CHECK(why_none(small(), close).find("too little") != std::string::npos);
}

TEST_CASE("light paths: casters hold all that is not diffuse, and lamps share the paths by power") {
  Scene scene = test::test_scene();
  scene.meshes[4].material = test::kGold;
  for (const uint32_t spheres : {0u, 40u}) {
    for (uint32_t i = 0; i < spheres; ++i) {
      scene.spheres.push_back({"s", {-0.9 + 0.045 * i, 0.8, 0.3}, 0.02, test::kMirrorMaterial});
    }
    const Plan plan = make_plan(scene, small());
    CHECK((spheres == 0 ? plan.casters.size() > 1 : plan.casters.size() == 1));
    const auto inside = [&](const glm::dvec3& point, double radius) {
      return std::ranges::any_of(plan.casters, [&](const Caster& c) {
        return glm::distance(point, {c.center[0], c.center[1], c.center[2]}) + radius <= c.radius;
      });
    };
    for (uint32_t prim = plan.triangles; prim < plan.triangles + plan.spheres; ++prim) {
      const float* s = &plan.prim_shape[4 * size_t{prim}];
      const bool casts = plan.prim_bin[prim] > kDiffuse && plan.prim_bin[prim] < kSurfaceBins;
      if (casts) CHECK(inside({s[0], s[1], s[2]}, s[3]));
    }
    const glm::dvec3 center(plan.center[0], plan.center[1], plan.center[2]);
    for (const glm::dvec3& corner : scene.meshes[4].positions) CHECK(inside(corner - center, 0));
  }
  const Plan plan = test::test_plan(small());
  REQUIRE(plan.lamp_paths.size() == 2);
  CHECK(paths_of_pass(plan) == doctest::Approx(32 * 24 / double(kPixelsPerLightPath)).epsilon(0.02));
  CHECK(plan.lamp_paths[0].per_pass > plan.lamp_paths[1].per_pass);  // the ceiling's is brighter
}

TEST_CASE("light paths: pieces are all paths of the passes, once each") {
  Settings settings;
  settings.width = 1200, settings.height = 900;
  const Plan plan = test::test_plan(settings);
  CHECK(passes_at_a_time(plan, 1) < 10);  // of a large picture
  CHECK(passes_at_a_time(test::test_plan(small()), 1) > 1000);
  for (const auto& [passes, workers] : {std::pair{1u, 1u}, {3u, 1u}, {3u, 100u}, {100u, 2u}}) {
    std::vector<uint64_t> next(plan.lights.size());
    for (size_t i = 0; i < next.size(); ++i) next[i] = 7 * uint64_t{plan.lamp_paths[i].per_pass};
    for (const LightPiece& piece : light_pieces(plan, 7, passes, workers)) {
      CHECK(piece.first == next[piece.light]);
      CHECK(piece.count > 0);
      CHECK(piece.epoch == light_path_epoch(piece.light, 0, 0));
      next[piece.light] += piece.count;
    }
    for (size_t i = 0; i < next.size(); ++i) CHECK(next[i] == (7 + passes) * plan.lamp_paths[i].per_pass);
  }
}

TEST_CASE("light paths: no two share their numbers, up to the last sample") {
  const Plan plan = test::test_plan(small());
  const uint64_t per_pass = paths_of_pass(plan);
  for (const uint64_t first : {(uint64_t{1} << 32) - 2, (uint64_t{1} << 48) / per_pass - 1, kMaxSpp - 4}) {
    uint64_t paths = 0;
    std::vector<LightPiece> pieces = light_pieces(plan, first, 4, 1), far = light_pieces(plan, 0, 4, 1);
    for (const LightPiece& piece : pieces) {
      paths += piece.count;
      // All of it has the epoch's upper digits.
      CHECK((piece.first >> 48) == ((piece.first + piece.count - 1) >> 48));
      for (const LightPiece& other : far) {
        const bool same = other.light == piece.light && other.epoch == piece.epoch;
        CHECK((!same || piece.first >= other.first + other.count));
      }
    }
    CHECK(paths == 4 * per_pass);
  }
  CHECK(light_path_epoch(0, 0, 0) != light_path_epoch(1, 0, 0));
  CHECK(light_path_epoch(0, 0, 0) != light_path_epoch(0, uint64_t{1} << 48, 0));
  CHECK(light_path_epoch(0, 0, 0) != light_path_epoch(0, 0, uint64_t{1} << 32));
  CHECK(light_path_epoch(0, 0, 0) == light_path_epoch(0, 5, 7));
}

TEST_CASE("light paths: a lamp that is switched off sends out none") {
  Scene scene = test::test_scene();
  scene.materials[test::kSmallLight].radiance = {0, 0, 0};
  const Plan plan = make_plan(scene, small());
  REQUIRE(has_light_paths(plan));
  CHECK(plan.lamp_paths[1].per_pass == 0);
  CHECK(render(plan).stats.invalid_samples == 0);
  scene.materials[test::kCeilingLight].radiance = {0, 0, 0};
  CHECK(why_none(small(), scene) == "no lamp");
}

TEST_CASE("light film: the same sums from any thread, in any order") {
  constexpr size_t kPixels = 5000;
  std::mt19937 rng(3);
  Splats splats;
  for (int i = 0; i < 20000; ++i) {
    const auto value = [&] { return std::uniform_real_distribution<float>(0, 3)(rng); };
    splats.push_back({static_cast<uint32_t>(rng() % kPixels), value(), value(), value()});
  }
  LightFilm one(kPixels), many(kPixels);
  one.add(splats);
  std::ranges::shuffle(splats, rng);
  std::vector<std::thread> threads;
  for (size_t k = 0; k < 4; ++k) {
    threads.emplace_back([&, k] {
      for (size_t i = 0; i < 5; ++i) {
        const auto first = splats.begin() + static_cast<ptrdiff_t>(5000 * k + 1000 * i);
        Splats some(first, first + 1000);
        many.add(some);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(std::ranges::equal(one.film().sums, many.film().sums));
  LightFilm sent(kPixels);
  const std::string packed = pack_splats(splats);
  ByteReader reader(packed);
  sent.add(reader);
  CHECK(std::ranges::equal(one.film().sums, sent.film().sums));
  for (const size_t length : {size_t{2}, packed.size() / 2 + 1, packed.size() - 1}) {
    ByteReader cut(std::string_view(packed).substr(0, length));
    CHECK_THROWS(sent.add(cut));
  }
  CHECK(many.passes() == 0);
  many.drew(3);
  CHECK(many.passes() == 3);
  const Splat& s = splats.front();
  LightFilm single(kPixels);
  Splats twice = {s, s};
  single.add(twice);
  const PixelMean mean = light_mean(single.film().sums[s.pixel], 4);
  const double y = luminance(double(s.r), double(s.g), double(s.b));
  CHECK(mean.rgb[0] == doctest::Approx(double(s.r) / 2));
  CHECK(double(mean.variance) == doctest::Approx(2 * y * y / 16));
  CHECK(light_mean(single.film().sums[s.pixel], 0).rgb[0] == 0);
}

TEST_CASE("light paths: the profile counts them") {
  const RenderResult with = render(test::test_plan(small()));
  Settings settings = small();
  settings.light_paths = false;
  const RenderResult without = render(test::test_plan(settings));
  const Profile& profile = with.profile;
  CHECK(profile.samples == without.profile.samples);
  CHECK(profile.light_paths == 8 * paths_of_pass(test::test_plan(small())));
  CHECK(profile.total(Stage::kEmit).paths == profile.light_paths);
  CHECK(profile.bounces[0][static_cast<size_t>(Stage::kIntersect)].rays == profile.samples + profile.light_paths);
  CHECK(profile.total(Stage::kConnectCamera).paths == profile.total(Stage::kSplat).paths);
  CHECK(profile.bounces[0][static_cast<size_t>(Stage::kConnectCamera)].paths ==
        0);  // that is for paths from the camera
  CHECK(profile.total(Stage::kIntersect).rays == profile.samples + profile.light_paths + profile.bounce_rays);
  CHECK(profile.total(Stage::kOcclude).rays + profile.total(Stage::kOccludeConnection).rays == profile.shadow_rays);
  CHECK(without.profile.light_paths == 0);
  CHECK(without.profile.total(Stage::kTakeLamps).calls == 0);
}

TEST_CASE("light paths: paths with corner normals make up for no more than a factor of 4 at a vertex") {
  const Plan plan = test::test_plan(small());
  std::mt19937 rng(9);
  const verify::KernelCase& kernel = verify::kernel_case("adjoint");
  PathBuffer buffer(1024);
  double least = 1e9, most = 0;
  for (const bool leaving : {false, true}) {
    for (uint32_t i = 0; i < 1024; ++i) {
      Path<float> p;
      p.slot = i;
      kernel.fill(plan, rng, p);
      p.beta_r = 1;
      store_path(buffer.state(), i, p);
    }
    buffer.state().step.leaving = leaving;
    adjoint(plan, buffer.state(), {0, 1024});
    for (uint32_t i = 0; i < 1024; ++i) {
      const double beta = double(buffer.state().beta_r[i]);
      if (beta > 0) least = std::min(least, beta);
      most = std::max(most, beta);
    }
  }
  CHECK(most <= 2.0001);
  CHECK(least >= 0.4999);
}

}  // namespace lanewise
