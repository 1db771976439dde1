#include "core/render.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

#include "core/image_compare.h"
#include "scenes/load.h"
#include "tests/kernel_harness.h"
#include "tests/scene_paths.h"
#include "core/verify/test_scene.h"

namespace lanewise {
namespace {

Settings small() {
  Settings settings;
  settings.width = 40, settings.height = 30, settings.spp = 16, settings.threads = 1;
  return settings;
}

double mean(const Image& image, size_t channel) {
  double sum = 0;
  for (size_t i = channel; i < image.rgb.size(); i += 3) sum += image.rgb[i];
  return 3 * sum / double(image.rgb.size());
}

// The share of pixels that differ by more than a hundredth.
double differing(const Image& a, const Image& b) {
  size_t n = 0;
  for (size_t i = 0; i < a.rgb.size(); i += 3) {
    for (size_t k = i; k < i + 3; ++k) {
      if (std::abs(a.rgb[k] - b.rgb[k]) > 0.01f * (0.01f + std::abs(b.rgb[k]))) {
        ++n;
        break;
      }
    }
  }
  return 3.0 * double(n) / double(a.rgb.size());
}

}  // namespace

TEST_CASE("render: SIMD paths are the scalar renderer's paths, in every mode") {
  // The same random numbers make the same paths; a few part where a rounded value decides otherwise.
  const auto check = [](const Settings& settings, const Scene& scene) {
    const Plan plan = make_plan(scene, settings);
    const RenderResult want = render_reference<float>(plan);
    test::for_each_target([&](const char* target) {
      CAPTURE(target);
      const RenderResult got = render(plan);
      CHECK(differing(got.image, want.image) < 0.02);
      for (size_t k = 0; k < 3; ++k) CHECK(mean(got.image, k) == doctest::Approx(mean(want.image, k)).epsilon(0.002));
      CHECK(got.stats.invalid_samples == 0);
      CHECK(got.stats.samples == want.stats.samples);
      const auto near = [](uint64_t a, uint64_t b) { return std::abs(double(a) - double(b)) <= 1e-3 * double(b); };
      CHECK(near(got.stats.bounce_rays, want.stats.bounce_rays));
      CHECK(near(got.stats.shadow_rays, want.stats.shadow_rays));
    });
    CHECK(differing(render_reference<double>(plan).image, want.image) < 0.03);
  };
  Settings settings = small();
  for (const uint32_t depth : {0u, 1u, 2u, 3u, 7u, 100u}) {
    CAPTURE(depth);
    settings.max_depth = depth;
    check(settings, test::test_scene());
  }
  settings = small();
  settings.first_sample = (uint64_t{1} << 32) - 5;
  check(settings, test::test_scene());
  settings = small();
  settings.light_samples = 3;
  check(settings, test::test_box());
  settings.light_samples = 1;
  for (const Direct direct : {Direct::kLight, Direct::kBsdf, Direct::kHemisphere}) {
    settings.direct = direct;
    check(settings, test::test_box());
  }
  settings.direct = Direct::kMis;
  for (const BsdfSampling sampling : {BsdfSampling::kNdf, BsdfSampling::kCosine}) {
    settings.bsdf_sampling = sampling;
    check(settings, test::test_box());
  }
  settings.bsdf_sampling = BsdfSampling::kVndf;
  for (const Fresnel fresnel : {Fresnel::kSchlick, Fresnel::kCourse}) {
    settings.fresnel = fresnel;
    check(settings, test::test_box());
  }
}

TEST_CASE("render: what was scattered once, twice, ... and not at all adds up to the whole picture") {
  // Path by path: with the same random numbers each layer holds a part of what a path gathers, so only sums differ in rounding.
  const auto check = [](Settings settings, const Scene& scene) {
    settings.max_depth = 4;
    const RenderResult whole = render(make_plan(scene, settings));
    std::vector<double> sum(whole.image.rgb.size(), 0);
    double first_layers = 0;
    for (uint32_t bounce = 0; bounce <= 4; ++bounce) {
      CAPTURE(bounce);
      settings.only_bounce = settings.max_depth = bounce;
      const Plan plan = make_plan(scene, settings);
      const RenderResult layer = render(plan);
      CHECK(differing(layer.image, render_reference<float>(plan).image) < 0.02);
      CHECK(mean(layer.image, 1) > 0);
      for (size_t i = 0; i < sum.size(); ++i) sum[i] += layer.image.rgb[i];
      if (bounce < 4) first_layers += mean(layer.image, 1);
    }
    CHECK(first_layers < mean(whole.image, 1));  // so the last one counts
    for (size_t i = 0; i < sum.size(); ++i) CHECK(sum[i] == doctest::Approx(whole.image.rgb[i]).epsilon(1e-4));
  };
  Settings settings = small();
  settings.estimate_error = false;
  check(settings, test::test_scene());
  settings.connect = false;
  check(settings, test::test_scene());
  settings.direct = Direct::kHemisphere;
  check(settings, test::test_box());
  settings = small();
  settings.estimate_error = false;
  check(settings, test::test_outdoors());
}

TEST_CASE("render: the same bits for any number of threads and any wave") {
  Settings adaptive = small(), noise = small();
  adaptive.adaptive_batch = 4, adaptive.adaptive_tolerance = 0.3;
  noise.spp = 200, noise.noise = 0.3;
  for (Settings settings : {small(), adaptive, noise}) {
    const RenderResult want = render(make_plan(test::test_scene(), settings));
    for (const uint32_t wave : {16u, 256u, 8192u}) {
      for (const uint32_t threads : {1u, 2u, 5u}) {
        settings.wave = wave, settings.threads = threads;
        const RenderResult got = render(make_plan(test::test_scene(), settings));
        CHECK(got.image.rgb == want.image.rgb);
        CHECK(got.samples == want.samples);
        CHECK(got.stats.paths_by_length == want.stats.paths_by_length);
      }
    }
  }
}

TEST_CASE("render: FMA targets agree bit for bit") {
  const Plan plan = make_plan(test::test_scene(), small());
  ZeroedVector<float> first;
  test::for_each_target([&](const char* target) {
    if (std::string(target) != "avx2" && std::string(target) != "avx512") return;
    const ZeroedVector<float> rgb = render(plan).image.rgb;
    if (first.empty()) first = rgb;
    CHECK(rgb == first);
  });
}

TEST_CASE("render: a crop's pixels are the whole picture's, also where blocks decide with their neighbours") {
  for (const double noise : {0.0, 0.3}) {
    Settings settings = small();
    if (noise > 0) settings.noise = noise, settings.spp = 200;
    const RenderResult whole = render(make_plan(test::test_scene(), settings));
    settings.crop = {7, 11, 20, 9};
    const RenderResult part = render(make_plan(test::test_scene(), settings));
    REQUIRE(part.image.width == 20);
    REQUIRE(part.image.height == 9);
    REQUIRE(part.samples.size() == 20 * 9);
    bool same = true;
    for (uint32_t y = 0; y < 9; ++y) {
      for (uint32_t x = 0; x < 20; ++x) {
        for (int k = 0; k < 3; ++k) same &= part.image.pixel(x, y)[k] == whole.image.pixel(x + 7, y + 11)[k];
        same &= part.samples[y * 20 + x] == whole.samples[(y + 11) * settings.width + x + 7];
      }
    }
    CHECK(same);
  }
}

TEST_CASE("render: a crop draws no pixel but its own and those of their squares, and the scalar renderer crops alike") {
  Settings settings = small();
  settings.crop = {7, 11, 20, 9};
  const Plan plan = make_plan(test::test_scene(), settings);
  const RenderResult part = render(plan), scalar = render_reference<float>(plan);
  CHECK(part.stats.samples == 22 * 10 * settings.spp);
  CHECK(differing(scalar.image, part.image) < 0.02);
}

TEST_CASE("render: another seed, another picture of the same scene") {
  Settings settings = small();
  const RenderResult a = render(make_plan(test::test_scene(), settings));
  settings.seed = uint64_t{1} << 40;
  const RenderResult b = render(make_plan(test::test_scene(), settings));
  CHECK(a.image.rgb != b.image.rgb);
  for (size_t k = 0; k < 3; ++k) CHECK(mean(a.image, k) == doctest::Approx(mean(b.image, k)).epsilon(0.1));
}

TEST_CASE("render: statistics add up") {
  Settings settings = small();
  const RenderResult result = render(make_plan(test::test_scene(), settings));
  const RenderStats& stats = result.stats;
  const uint64_t samples = uint64_t{settings.width} * settings.height * settings.spp;
  CHECK(stats.samples == samples);
  CHECK(std::accumulate(stats.paths_by_length.begin(), stats.paths_by_length.end(), uint64_t{0}) == samples);
  CHECK(stats.paths_by_length.size() <= settings.max_depth + 1);
  uint64_t intersected = 0;
  for (const StageStats& s : stats.stages) {
    CHECK(s.calls > 0);
    CHECK(s.lanes_live > 0);
    CHECK(s.lanes_live <= 1);
    if (s.name == "intersect") intersected = s.paths;
  }
  // Every bounce but the last traces what the one before left; the dead among them are counted, not traced.
  CHECK(stats.camera_rays + stats.bounce_rays <= intersected);
  CHECK(stats.shadow_rays > 0);
}

TEST_CASE("render: every stage's lanes are 95% full where waves are, also those that few paths of a bounce come to") {
  Settings settings;
  settings.width = 64, settings.height = 48, settings.threads = 1;
  const Plan plan = make_plan(load_scene(test::shipped_scene("cornell_spheres.dae").string()), settings);
  for (const StageStats& s : render(plan).stats.stages) {
    CAPTURE(s.name);
    CHECK(s.lanes_live > 0.95);
  }
}

TEST_CASE("render: -a takes fewer samples where the picture is calm") {
  Settings settings = small();
  settings.spp = 256;
  settings.adaptive_batch = 16;
  settings.adaptive_tolerance = 0.2;
  const RenderResult result = render(make_plan(test::test_scene(), settings));
  uint64_t total = 0;
  for (const uint64_t n : result.samples) {
    CHECK(n % 16 == 0);
    CHECK(n >= 16);
    total += n;
  }
  CHECK(total == result.stats.samples);
  CHECK(total < 256 * result.samples.size());
  CHECK(total > 16 * result.samples.size());
}

TEST_CASE("render: --noise comes to the noise that it is asked for, in both renderers") {
  Settings settings = small();
  settings.spp = 4096, settings.max_depth = 3;
  Settings exact = settings;
  exact.seed = 1;
  const Image want = render(make_plan(test::test_box(), exact)).image;
  uint64_t before = 0;
  for (const double noise : {0.2, 0.1}) {
    settings.noise = noise;
    const Plan plan = make_plan(test::test_box(), settings);
    const RenderResult got = render(plan);
    CAPTURE(noise);
    CHECK(compare_images(got.image, want).mrse < noise * noise);
    CHECK(compare_images(got.image, want).mrse > noise * noise / 10);
    CHECK(got.stats.converged > 0.9);
    CHECK(std::accumulate(got.samples.begin(), got.samples.end(), uint64_t{0}) == got.stats.samples);
    CHECK(got.stats.samples > 2 * before);  // 4 times in theory
    before = got.stats.samples;
    if (noise > 0.1) CHECK(differing(render_reference<float>(plan).image, got.image) < 0.05);
  }
}

TEST_CASE("render: the glass sphere's shadow is black at -m 2 where nothing but light through glass could reach") {
  // One scattering more than direct light brings none through two refractions.
  Scene scene = test::test_box();
  for (Material& m : scene.materials) {
    if (m.kind == Material::Kind::kDiffuse && m.name != "white") m.reflectance = glm::dvec3(0);
  }
  scene.meshes = {scene.meshes[0], scene.meshes[5]};  // floor and light
  scene.spheres = {scene.spheres[1]};
  scene.spheres[0].center = {0, 0, 0.4};
  scene.spheres[0].radius = 0.39;
  scene.cameras[0].to_world = glm::dmat4(1.0);
  scene.cameras[0].to_world[0] = {1, 0, 0, 0};
  scene.cameras[0].to_world[1] = {0, 1, 0, 0};
  scene.cameras[0].to_world[2] = {0, 0, 1, 0};
  scene.cameras[0].to_world[3] = {0.12, 0, 0.005, 1};  // between sphere and floor, looking down at the umbra
  Settings settings = small();
  settings.spp = 64, settings.max_depth = 2;
  const RenderResult result = render(make_plan(scene, settings));
  CHECK(*std::max_element(result.image.rgb.begin(), result.image.rgb.end()) == 0);
  settings.max_depth = 3;  // floor, into the glass, out of it: the caustic
  CHECK(mean(render(make_plan(scene, settings)).image, 0) > 0.01);
}

}  // namespace lanewise
