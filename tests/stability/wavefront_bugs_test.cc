// Bugs that only wavefront renderers have, from the issue lists of others: depth counted differently from the scalar renderer
// (pbrt-v4 445), NaN from degenerate light triangles (openmoonray 251), dead lanes and empty statistics (openmoonray 249), and
// random numbers whose order depends on the wave (pbrt-v4 85).
#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <span>

#include "core/render.h"
#include "tests/kernel_harness.h"
#include "tests/stability/cavity.h"
#include "tests/stability/curve.h"
#include "core/verify/test_scene.h"

namespace lanewise {
namespace {

#ifdef NDEBUG
constexpr uint32_t kSamples = 16;
#else
constexpr uint32_t kSamples = 2;
#endif

Settings small() {
  Settings settings;
  settings.width = 32, settings.height = 24, settings.spp = kSamples, settings.threads = 1;
  return settings;
}

double mean(const Image& image) {
  double sum = 0;
  for (const float x : image.rgb) sum += double{x};
  return sum / static_cast<double>(image.rgb.size());
}

double difference(const Image& a, const Image& b) { return std::abs(mean(a) / mean(b) - 1); }

// The share of pixels whose bits differ.
double changed(std::span<const float> a, std::span<const float> b) {
  size_t n = 0;
  for (size_t i = 0; i < a.size(); i += 3) n += !std::equal(&a[i], &a[i] + 3, &b[i]);
  return 3.0 * static_cast<double>(n) / static_cast<double>(a.size());
}

TEST_SUITE("stability") {
  TEST_CASE("wavefront: depth is counted as the scalar renderer counts it") {
    test::Curve curve{.name = "wavefront-depth",
                      .title = "Depth counted differently from the scalar renderer",
                      .naive = "off by one: the camera ray not counted, or counted twice",
                      .ours = "render against render_reference<double>",
                      .x_axis = "-m, most scattering events on a path",
                      .y_axis = "relative difference of the mean radiance",
                      .log_x = false,
                      .points = {}};
    Settings settings = small();
    for (uint32_t depth = 0; depth <= 8; ++depth) {
      CAPTURE(depth);
      double naive = 0, ours = 0;
      for (const Scene& scene : {test::test_scene(), test::cavity(0.9)}) {
        settings.max_depth = depth;
        const Plan plan = make_plan(scene, settings);
        const RenderResult want = render_reference<float>(plan), exact = render_reference<double>(plan);
        settings.max_depth = depth + 1;
        if (mean(exact.image) > 0) {
          naive = std::max(naive, difference(render(make_plan(scene, settings)).image, exact.image));
        }
        test::for_each_target([&](const char* target) {
          CAPTURE(target);
          const RenderResult got = render(plan);
          if (mean(exact.image) > 0) ours = std::max(ours, difference(got.image, exact.image));
          CHECK(got.stats.paths_by_length.size() == want.stats.paths_by_length.size());
          // A few paths part where the last bit decides.
          uint64_t moved = 0;
          for (size_t k = 0; k < got.stats.paths_by_length.size(); ++k) {
            const uint64_t a = got.stats.paths_by_length[k], b = want.stats.paths_by_length[k];
            moved += a > b ? a - b : b - a;
          }
          CHECK(double(moved) <= 1e-3 * double(got.stats.samples));
        });
      }
      curve.points.push_back({double(depth), naive, ours});
    }
    CHECK(curve.points[0].naive > 0.5);
    CHECK(curve.points[8].naive > 0.01);
    CHECK(curve.worst_ours() < 2e-3);
    test::record(curve);
  }

  TEST_CASE("wavefront: and as the theory counts it") {
    Settings settings = small();
    settings.spp = 16 * kSamples;
    settings.reuse = false;  // so that pixels do not hang together
    for (const Direct direct : {Direct::kMis, Direct::kLight, Direct::kBsdf}) {
      for (uint32_t depth = 0; depth <= 4; ++depth) {
        CAPTURE(depth);
        settings.max_depth = depth, settings.direct = direct;
        const Image image = render(make_plan(test::cavity(0.9), settings)).image;
        const double want = test::cavity_radiance(0.9, depth), got = mean(image);
        double squares = 0;
        for (size_t i = 0; i < image.rgb.size(); i += 3)
          squares += (double{image.rgb[i]} - got) * (double{image.rgb[i]} - got);
        const double pixels = static_cast<double>(image.rgb.size() / 3);
        CHECK(std::abs(got - want) <= 4.5 * std::sqrt(squares) / pixels);
        // Enough samples to tell one bounce more or less.
        if (kSamples == 16) CHECK(4.5 * std::sqrt(squares) / pixels < 0.2 * test::cavity_radiance(0.9, 1));
      }
    }
  }

  TEST_CASE("wavefront: light triangles down to nothing make no invalid sample") {
    test::Curve curve{.name = "degenerate-lights",
                      .title = "Light triangles down to nothing",
                      .naive = "power heuristic by squares: p^2 / (p^2 + q^2)",
                      .ours = "whole renders, weights by ratios",
                      .x_axis = "edge of the light's triangle (size of the scene)",
                      .y_axis = "share of invalid samples",
                      .points = {}};
    std::mt19937 rng(20);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int exponent = -1; exponent >= -18; --exponent) {
      const double size = std::pow(10.0, exponent);
      CAPTURE(size);
      // The naive weight of samples at distances of the scene's size.
      const float area = 0.5f * static_cast<float>(size) * static_cast<float>(size);
      uint32_t naive = 0;
      constexpr uint32_t kTries = 1000;
      for (uint32_t i = 0; i < kTries; ++i) {
        const float distance = 0.1f + unit(rng), cosine = 1e-3f + 0.999f * unit(rng);
        const float p = distance * distance / (area * cosine), q = 0.318f * cosine;
        naive += std::isnan(p * p / (p * p + q * q) / p);
      }
      // Around the plan's centre, where floats tell its corners apart; of constant power as far as floats go.
      uint64_t invalid = 0, samples = 0;
      for (const double thin : {1.0, 1e-4}) {
        Scene scene = test::test_box();
        Mesh light = scene.meshes.back();
        const glm::dvec3 center(0, 0, 0.75);
        light.positions = {center, center + size * glm::dvec3(1, 0.2, 0.1),
                           center + thin * size * glm::dvec3(0.1, 1, -0.3)};
        light.material = static_cast<uint32_t>(scene.materials.size());
        scene.materials.push_back(scene.materials[test::kSmallLight]);
        scene.materials.back().radiance = glm::dvec3(std::min(1e30, 1 / (thin * size * size)));
        scene.meshes.push_back(light);
        finish_scene(scene);
        for (const Direct direct : {Direct::kMis, Direct::kLight, Direct::kBsdf}) {
          Settings settings = small();
          settings.direct = direct, settings.spp = 2;
          const Plan plan = make_plan(scene, settings);
          CHECK(plan.lights.size() == 3);
          test::for_each_target([&](const char* target) {
            CAPTURE(target);
            const RenderResult result = render(plan);
            CHECK(result.stats.invalid_samples == 0);
            CHECK(std::ranges::all_of(result.image.rgb, [](float x) { return x >= 0 && std::isfinite(x); }));
            invalid += result.stats.invalid_samples;
            samples += result.stats.samples;
          });
        }
      }
      curve.points.push_back({size, double(naive) / kTries, double(invalid) / double(samples)});
    }
    CHECK(curve.points.front().naive == 0);
    CHECK(curve.worst_naive() == 1);
    CHECK(curve.worst_ours() == 0);
    test::record(curve);
  }

  TEST_CASE("wavefront: dead lanes may hold anything without the living noticing") {
    // Kernels divide by zero and multiply infinities in lanes that they then mask, so floating-point exceptions stay masked;
    // what counts is that nothing of it reaches a living path: with NaNs in all other lanes every bit is the same.
    const Plan plan = test::test_plan();
    const std::pair<const char*, Kernel*> kernels[] = {{"intersect", intersect},
                                                       {"emission", emission},
                                                       {"surface", surface},
                                                       {"sample_light", sample_light},
                                                       {"light_diffuse", light_diffuse},
                                                       {"light_microfacet", light_microfacet},
                                                       {"occlude", occlude},
                                                       {"gather_emission", gather_emission},
                                                       {"shade_diffuse", shade_diffuse},
                                                       {"shade_microfacet", shade_microfacet},
                                                       {"shade_mirror", shade_mirror},
                                                       {"shade_glass", shade_glass},
                                                       {"roulette", roulette},
                                                       {"sample_hemisphere", sample_hemisphere}};
    test::for_each_target([&](const char* target) {
      CAPTURE(target);
      for (const auto& [name, kernel] : kernels) {
        CAPTURE(name);
        std::vector<Path<float>> results[2];
        for (const bool poisoned : {false, true}) {
          std::mt19937 rng(21);
          PathBuffer buffer(256);
          PathState& s = buffer.state();
          s.step.bounce = kRouletteBounce;
          for (uint32_t i = 0; i < 256; ++i) {
            Path<float> p;
            test::fill_random(plan, rng, p, i);
            if (poisoned && i % 3 != 0) {  // two of three lanes are dead: no throughput, and NaN or infinity elsewhere
              const float bad = i % 3 == 1 ? NAN : INFINITY;
              const uint32_t prim = p.prim;
#define LANEWISE_POISON(type, field, meaning) \
  if constexpr (std::is_same_v<type, float>) p.field = static_cast<type>(bad);
              LANEWISE_PATH_FIELDS(LANEWISE_POISON, LANEWISE_POISON)
#undef LANEWISE_POISON
              p.beta_r = p.beta_g = p.beta_b = p.c_r = p.c_g = p.c_b = 0;
              p.prim = prim;
            }
            store_path(s, i, p);
          }
          kernel(plan, s, {0, 256});
          for (uint32_t i = 0; i < 256; i += 3) results[poisoned].push_back(load_path<float>(s, i));
        }
        uint32_t wrong = 0;
        for (size_t i = 0; i < results[0].size(); ++i) {
#define LANEWISE_COMPARE(type, field, meaning) \
  wrong += std::bit_cast<uint32_t>(results[0][i].field) != std::bit_cast<uint32_t>(results[1][i].field);
          LANEWISE_PATH_FIELDS(LANEWISE_COMPARE, LANEWISE_COMPARE)
#undef LANEWISE_COMPARE
        }
        CHECK(wrong == 0);
      }
    });
  }

  TEST_CASE("wavefront: statistics of waves that are nearly empty, or all missed, hold numbers") {
    Scene away = test::test_box();
    away.cameras[0].to_world[2] = {0, 1, 0, 0};  // looks away from the box
    away.cameras[0].to_world[0] = {-1, 0, 0, 0};
    for (const auto& [scene, width, height] :
         {std::tuple(test::test_scene(), 1u, 1u), {away, 32u, 24u}, {away, 1u, 1u}}) {
      for (const uint32_t depth : {0u, 5u}) {
        Settings settings = small();
        settings.width = width, settings.height = height, settings.spp = 1, settings.wave = 16,
        settings.max_depth = depth;
        const RenderResult result = render(make_plan(scene, settings));
        CHECK(result.stats.samples == width * height);
        CHECK(result.stats.invalid_samples == 0);
        uint64_t paths = 0;
        for (const uint64_t n : result.stats.paths_by_length) paths += n;
        CHECK(paths == width * height);
        for (const StageStats& stage : result.stats.stages) {
          CHECK(stage.lanes_live > 0);  // fails for NaN
          CHECK(stage.lanes_live <= 1);
          CHECK(stage.paths > 0);
        }
        if (width > 1) CHECK(mean(result.image) == 0);
      }
    }
  }

  TEST_CASE("wavefront: random numbers do not depend on the wave") {
    test::Curve curve{.name = "wavefront-order",
                      .title = "Pixels that change with the wave's size",
                      .naive = "one generator, drawn from stage by stage",
                      .ours = "whole renders, kernels/rng-inl.h",
                      .x_axis = "paths in a wave, against 4096",
                      .y_axis = "share of pixels with other bits",
                      .points = {}};
    Settings settings = small();
    const uint32_t pixels = settings.width * settings.height;
    const auto naive = [&](uint32_t wave) {
      // Each sample is a product of two decisions; a stage draws the first of all paths of the wave, the next the second.
      std::mt19937 rng(22);
      std::uniform_real_distribution<float> unit(0, 1);
      std::vector<float> film(size_t{3} * pixels, 0.0f), beta(wave);
      for (uint32_t first = 0; first < pixels * settings.spp; first += wave) {
        for (float& b : beta) b = unit(rng);
        for (float& b : beta) b *= unit(rng);
        for (uint32_t i = 0; i < wave && first + i < pixels * settings.spp; ++i) {
          film[size_t{3} * ((first + i) / settings.spp)] += beta[i];
        }
      }
      return film;
    };
    settings.wave = 4096;
    const std::vector<float> naive_want = naive(4096);
    const ZeroedVector<float> want = render(make_plan(test::test_scene(), settings)).image.rgb;
    for (const uint32_t wave : {16u, 64u, 256u, 1024u, 8192u}) {
      settings.wave = wave;
      double ours = 0;
      for (const uint32_t threads : {1u, 3u}) {
        settings.threads = threads;
        ours = std::max(ours, changed(render(make_plan(test::test_scene(), settings)).image.rgb, want));
      }
      curve.points.push_back({double(wave), changed(naive(wave), naive_want), ours});
    }
    CHECK(curve.worst_naive() > 0.5);
    CHECK(curve.worst_ours() == 0);
    test::record(curve);
  }
}

}  // namespace
}  // namespace lanewise
