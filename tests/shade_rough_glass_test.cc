#include "kernels/reference/shade_rough_glass.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "core/render.h"
#include "core/verify/fields.h"
#include "core/verify/test_scene.h"
#include "kernels/reference/shade_glass.h"
#include "tests/kernel_harness.h"
#include "tests/shading_harness.h"
#include "tests/statistics/chi_square.h"
#include "tests/statistics/lobes.h"
#include "tests/statistics/significance.h"

namespace lanewise {
namespace {

using namespace test::lobes;
using glm::dvec3;
using std::numbers::pi;

PlanMaterial rough(float ior, float alpha) {
  PlanMaterial m = test::grey(1);
  m.ior = ior;
  m.alpha = alpha;
  return m;
}

// All directions, from straight up over the horizon to straight down: sqrt(1 - |cos|), then 2 minus that, and azimuth. Lobes
// around the normal are some cells wide.
double height(const Vec& w) {
  const double t = std::sqrt(std::max(0.0, 1 - std::abs(w.z)));
  return w.z > 0 ? t : 2 - t;
}

test::Domain sphere(const OfDirection& value, uint32_t rows = test::kLobeSide) {
  return {{0, 2}, {-pi, pi}, 2 * test::kLobeSide, rows, [value](double x, double azimuth) {
            const double t = x < 1 ? x : 2 - x, cosine = 1 - t * t, sine = t * std::sqrt(2 - t * t);
            return 2 * t * value({sine * std::cos(azimuth), sine * std::sin(azimuth), x < 1 ? cosine : -cosine});
          }};
}

}  // namespace

TEST_CASE("shade_rough_glass, light_rough_glass: SIMD against their twins for every Fresnel model and mode") {
  const auto awkward = [](std::mt19937& rng, Path<float>& p) {
    const float cosines[] = {1, -1, 1.7e-4f, -1.7e-4f, 0.5f, -0.5f};
    test::arrive(rng, p, cosines[rng() % 6]);
    if (rng() % 8 == 0) p.l_x = p.l_y = p.l_z = 0, p.l_pdf = 0;
    if (rng() % 8 == 0) p.beta_r = p.beta_g = p.beta_b = 0;
  };
  for (const Fresnel fresnel : {Fresnel::kExact, Fresnel::kSchlick, Fresnel::kCourse}) {
    for (const Direct direct : {Direct::kMis, Direct::kLight, Direct::kHemisphere}) {
      Settings settings;
      settings.fresnel = fresnel;
      settings.direct = direct;
      settings.light_samples = 3;
      const Plan plan =
          test::material_plan({rough(1.5f, 0.3f), rough(1.5f, 1), rough(0.67f, 0.1f), rough(2.5f, 0.05f)}, settings);
      for (const char* kernel : {"shade_rough_glass", "light_rough_glass"}) {
        test::check_kernel(plan, kernel);
        test::check_kernel(plan, kernel, {}, awkward);
      }
    }
  }
}

TEST_CASE("shade_rough_glass: nothing but numbers, whatever the index, the roughness and the arrival") {
  std::vector<PlanMaterial> materials;
  for (const float ior : {1e-3f, 0.5f, 0.999f, 1.0f, 1.001f, 1.5f, 100.0f}) {
    for (const float alpha : {0.0f, 1e-4f, 0.1f, 1.0f, 1000.0f}) materials.push_back(rough(ior, alpha));
  }
  const Plan plan = test::material_plan(materials);
  std::mt19937 rng(3);
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    constexpr uint32_t kPaths = 8192;
    PathBuffer paths(kPaths);
    for (uint32_t i = 0; i < kPaths; ++i) {
      Path<float> p;
      test::fill_random(plan, rng, p, i);
      const float cosines[] = {1, -1, 1e-7f, -1e-7f, 0.6f, -0.6f, 0, 0.74535599f};
      test::arrive(rng, p, cosines[rng() % 8]);
      store_path(paths.state(), i, p);
    }
    light_rough_glass(plan, paths.state(), {0, kPaths});
    shade_rough_glass(plan, paths.state(), {0, kPaths});
    uint32_t bad = 0;
    for (uint32_t i = 0; i < kPaths; ++i) {
      const Path<float> p = load_path<float>(paths.state(), i);
      bad += !(p.c_r >= 0 && std::isfinite(p.c_r)) || !(p.beta_r >= 0 && std::isfinite(p.beta_r));
      bad += !(p.pdf >= 0 && std::isfinite(p.pdf)) || !(std::abs(glm::length(LANEWISE_VEC3(p, d)) - 1) < 1e-6f);
    }
    CHECK(bad == 0);
  });
}

TEST_CASE("chi-square: rough glass reflects and refracts with its density, from either side, on every target") {
  test::Family family;
  test::for_each_target([&](const char* target) {
    for (const float alpha : {0.05f, 0.3f, 0.8f}) {
      for (const double degrees : {0.0, 40.0, 75.0, 110.0, 150.0, 180.0}) {  // above 90 from inside
        Settings settings;
        settings.seed = family.tests();
        const Plan plan = test::material_plan({rough(1.5f, alpha)}, settings);
        Arrival arrival(kTilted, degrees);
        const bool inside = degrees > 90;
        const reference::RoughGlass<double> glass(plan.materials[0], inside);
        const Vec wo(arrival.wo.x, arrival.wo.y, std::abs(arrival.wo.z));
        const double side = inside ? -1 : 1;
        // Off the normal the lobes of small alpha are narrow in azimuth; quadrature finds 1.0002 for the integral otherwise.
        const uint32_t rows = test::kLobeSide * (alpha < 0.1f ? 4 : 1);
        const auto pdf_of = [&](const Vec& w) {
          return reference::evaluate_rough_glass(Fresnel::kExact, glass, wo, Vec(w.x, w.y, side * w.z)).pdf;
        };
        test::ChiSquare test(sphere(pdf_of, rows));
        double worst = 0;
        test::for_each_draw(shade_rough_glass, plan, arrival.path, test::kDraws / 4,
                            [&](const PathState& s, uint32_t i) {
                              if (s.pdf[i] == 0) return test.add_void();
                              const Vec w = arrival.next(s, i);
                              test.add(height(w), std::atan2(w.y, w.x));
                              worst = std::max(worst, std::abs(s.pdf[i] / pdf_of(w) - 1));
                            });
        CHECK(worst < 2e-3);
        family.add(std::string(target) + " alpha " + std::to_string(alpha) + ", " + std::to_string(degrees), test.p());
      }
    }
  });
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

TEST_CASE("energy: rough glass gives what f cos integrates to, and no more than it gets") {
  test::Family family;
  for (const float alpha : {0.1f, 0.3f, 1.0f}) {
    for (const double degrees : {0.0, 50.0, 80.0, 120.0, 170.0}) {
      Settings settings;
      settings.seed = 100 + family.tests();
      const Plan plan = test::material_plan({rough(1.5f, alpha)}, settings);
      const Arrival arrival(kUp, degrees);
      const reference::RoughGlass<double> glass(plan.materials[0], degrees > 90);
      const Vec wo(arrival.wo.x, arrival.wo.y, std::abs(arrival.wo.z));
      const double all = test::integrate(
          sphere([&](const Vec& w) { return reference::evaluate_rough_glass(Fresnel::kExact, glass, wo, w).f_cos; }));
      CHECK(all < 1 + 1e-4);
      CHECK(all > (alpha < 0.2f && degrees < 45 ? 0.99 : 0.4));
      // Refracted radiance over the index squared is what is conserved.
      const double squeeze = (glass.n_t / glass.n_i) * (glass.n_t / glass.n_i);
      test::Moments weights;
      test::for_each_draw(shade_rough_glass, plan, arrival.path, test::kDraws / 4, [&](const PathState& s, uint32_t i) {
        const bool refracted = arrival.next(s, i).z * arrival.wo.z < 0;
        weights.add(s.beta_b[i] * (refracted ? squeeze : 1));
      });
      family.add("alpha " + std::to_string(alpha) + ", " + std::to_string(degrees), test::t_test_p(weights, all, 1e-4));
    }
  }
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

TEST_CASE("reciprocity: rough glass carries L / n^2 as well there as back") {
  std::mt19937 rng(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const float alpha : {0.05f, 0.3f, 1.0f}) {
    const PlanMaterial m = rough(1.5f, alpha);
    const reference::RoughGlass<double> outside(m, false), inside(m, true);
    double worst = 0;
    int compared = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vec wo = reference::uniform_hemisphere(unit(rng), unit(rng));
      const Vec wi = -reference::uniform_hemisphere(unit(rng), unit(rng));
      // f = f_cos / |cos|, and n_o^2 f is the same both ways (Walter et al. 2007, sec. 5); radiance's squeeze left out.
      const double there = reference::evaluate_rough_glass(Fresnel::kExact, outside, wo, wi).f_cos / -wi.z;
      const double back = reference::evaluate_rough_glass(Fresnel::kExact, inside, -wi, -wo).f_cos / wo.z;
      if (there < 1e-6 || wo.z < 0.02 || wi.z > -0.02) continue;
      ++compared;
      worst = std::max(worst, std::abs(there / (back * 1.5 * 1.5) - 1));
    }
    CHECK(compared > 30);
    CHECK(worst < 1e-9);
  }
}

TEST_CASE("shade_rough_glass: goes over into smooth glass with its roughness") {
  const Plan rough_plan = test::material_plan({rough(1.5f, 1e-4f)}),
             smooth_plan = test::material_plan({rough(1.5f, 0)});
  std::mt19937 rng(11);
  for (int i = 0; i < 1000; ++i) {
    Path<float> p;
    test::fill_random(rough_plan, rng, p, 0);
    test::arrive(rng, p, i % 2 ? 0.8f : -0.9f);
    LANEWISE_SET_VEC3(p, n, LANEWISE_VEC3(p, s));
    Path<double> a = verify::convert_path<double>(p), b = a;
    reference::shade_rough_glass(rough_plan, a);
    reference::shade_glass(smooth_plan, b);
    if (glm::dot(LANEWISE_VEC3(a, d), LANEWISE_VEC3(b, d)) < 0) continue;  // another lobe, at the edge between them
    CHECK(glm::length(LANEWISE_VEC3(a, d) - LANEWISE_VEC3(b, d)) < 3e-3);
    CHECK(a.beta_r == doctest::Approx(b.beta_r).epsilon(1e-3));
  }
}

TEST_CASE("rough glass: every way to look for light gives the same picture") {
  Scene scene = test::test_box();
  scene.materials[test::kGlassMaterial].roughness = 0.4;
  Settings settings;
  settings.width = 16, settings.height = 12, settings.threads = 1, settings.max_depth = 4;
  const auto mean = [&](Direct direct, uint32_t spp) {
    settings.direct = direct;
    settings.spp = spp;
    const RenderResult result = render(make_plan(scene, settings));
    CHECK(result.stats.invalid_samples == 0);
    double sum = 0;
    for (const float x : result.image.rgb) sum += x;
    return sum / static_cast<double>(result.image.rgb.size());
  };
  const double mis = mean(Direct::kMis, 4096);
  CHECK(mean(Direct::kLight, 4096) == doctest::Approx(mis).epsilon(0.005));
  CHECK(mean(Direct::kBsdf, 16384) == doctest::Approx(mis).epsilon(0.01));
  CHECK(mean(Direct::kHemisphere, 8192) == doctest::Approx(mis).epsilon(0.01));
}

namespace {

// A pane at z = 0 seen from above, between a light over it and one under it, of which `over` and `under` are on.
Scene pane(bool over, bool under) {
  Scene scene = test::test_box();
  scene.spheres.clear();
  scene.materials[test::kGlassMaterial].roughness = 0.4;
  scene.materials[test::kCeilingLight].radiance = dvec3(10);
  const auto square = [](const char* name, uint32_t material, double side, const dvec3& at, bool up) {
    Mesh mesh;
    mesh.name = name;
    mesh.material = material;
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
      mesh.positions.push_back(at + dvec3(side * x, side * y, 0));
    }
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    if (!up) mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
    return mesh;
  };
  scene.meshes = {square("pane", test::kGlassMaterial, 2, {0, 0, 0}, true)};
  if (over) scene.meshes.push_back(square("over", test::kCeilingLight, 0.7, {1.5, 0, 1.5}, false));
  if (under) scene.meshes.push_back(square("under", test::kCeilingLight, 0.7, {0.3, 0, -1}, true));
  scene.cameras[0].to_world = glm::dmat4(1.0);
  scene.cameras[0].to_world[3] = {-1, 0, 3, 1};
  return scene;
}

}  // namespace

TEST_CASE("rough glass: light samples find what scattering finds, reflected and refracted, on every target") {
  Settings settings;
  settings.width = 6, settings.height = 4, settings.threads = 1, settings.max_depth = 1;
  test::for_each_target([&](const char* target) {
    for (const bool under : {false, true}) {
      CAPTURE(target);
      CAPTURE(under);
      const auto mean = [&](Direct direct, uint32_t spp) {
        settings.direct = direct;
        settings.spp = spp;
        double sum = 0;
        // What is scattered once, and not the light behind the pane that a camera ray meets.
        settings.only_bounce = 1;
        const Image image = render(make_plan(pane(!under, under), settings)).image;
        for (const float x : image.rgb) sum += x;
        return sum / static_cast<double>(image.rgb.size());
      };
      const double light = mean(Direct::kLight, 1024);
      CHECK(light > 0.01);
      CHECK(mean(Direct::kBsdf, 8192) == doctest::Approx(light).epsilon(0.02));
      CHECK(mean(Direct::kMis, 1024) == doctest::Approx(light).epsilon(0.01));
    }
  });
}

TEST_CASE("rough glass: smooth where roughness or index leave nothing rough") {
  Material m;
  m.kind = Material::Kind::kGlass;
  m.roughness = 0.1;
  CHECK(is_rough_glass(m));
  m.ior = 1.0005;
  CHECK(!is_rough_glass(m));
  m.ior = 1.5, m.roughness = 5e-5;
  CHECK(!is_rough_glass(m));
  m.kind = Material::Kind::kMicrofacet, m.roughness = 1;
  CHECK(!is_rough_glass(m));
}

}  // namespace lanewise
