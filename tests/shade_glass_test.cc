#include "kernels/reference/shade_glass.h"

#include <doctest/doctest.h>

#include "core/verify/fields.h"
#include "tests/kernel_harness.h"
#include "tests/shading_harness.h"

namespace lanewise {
namespace {

struct Arrival {
  double c, n_i, n_t, u, reflectance, g2;
};

Arrival arrival(const Plan& plan, const Path<float>& before) {
  const Path<double> p = verify::convert_path<double>(before);
  Arrival a;
  const double cosine = -glm::dot(LANEWISE_VEC3(p, d), LANEWISE_VEC3(p, s));
  const double ior = reference::material_at(plan, p).ior;
  a.c = std::min(std::abs(cosine), 1.0);
  a.n_i = cosine < 0 ? ior : 1;
  a.n_t = cosine < 0 ? 1 : ior;
  a.u = reference::draw_glass_lobe(plan, p);
  a.reflectance = reference::fresnel_dielectric(plan.settings.fresnel, a.c, a.n_i, a.n_t).reflectance;
  a.g2 = a.n_t * a.n_t - a.n_i * a.n_i * (1 - a.c * a.c);
  return a;
}

Plan glasses(const Settings& settings = {}) {
  return test::material_plan(
      {test::glass(1), test::glass(1.0001f), test::glass(1.45f), test::glass(2.5f), test::glass(1 / 1.5f)}, settings);
}

}  // namespace

TEST_CASE("shade_glass: SIMD against its twin for every Fresnel model") {
  for (const Fresnel fresnel : {Fresnel::kExact, Fresnel::kSchlick, Fresnel::kCourse}) {
    Settings settings;
    settings.fresnel = fresnel;
    const Plan plan = glasses(settings);
    test::check_kernel(test::test_plan(settings), "shade_glass");
    test::check_kernel(plan, "shade_glass");
    test::check_kernel(plan, "shade_glass", {}, [](std::mt19937& rng, Path<float>& p) {
      const float cosines[] = {1, -1, 0.01f, -0.01f, 1.7e-4f, -1.7e-4f, 0.7f, -0.7f};
      test::arrive(rng, p, cosines[rng() % 8]);
    });
  }
}

TEST_CASE("shade_glass: around the critical angle all lanes reflect or carry a finite unit direction") {
  const Plan plan = test::material_plan({test::glass(1.5f)});
  const double critical = std::sqrt(1 - 1 / (1.5 * 1.5));
  std::mt19937 rng(3);
  test::for_each_target([&](const char*) {
    PathBuffer paths(1024);
    for (uint32_t i = 0; i < 1024; ++i) {
      Path<float> p;
      test::fill_random(plan, rng, p, i);
      // Four ulps to either side of sin^2 = 1.
      test::arrive(rng, p, static_cast<float>(-critical * (1 + 1.2e-7 * (int(i % 9) - 4))));
      store_path(paths.state(), i, p);
    }
    shade_glass(plan, paths.state(), {0, 1024});
    int bad = 0;
    for (uint32_t i = 0; i < 1024; ++i) {
      const Path<float> p = load_path<float>(paths.state(), i);
      const double length = glm::length(reference::Vec3<double>(p.d_x, p.d_y, p.d_z));
      bad += !(std::abs(length - 1) < 2.4e-7) || !std::isfinite(p.beta_r);
    }
    CHECK(bad == 0);
  });
}

TEST_CASE("shade_glass: Snell's law, unit directions, the squared ratio of indices") {
  const Plan plan = glasses();
  std::mt19937 rng(5);
  constexpr uint32_t kPaths = 4096;
  PathBuffer paths(kPaths);
  std::vector<Path<float>> before(kPaths);
  for (uint32_t i = 0; i < kPaths; ++i) {
    test::fill_random(plan, rng, before[i], i);
    store_path(paths.state(), i, before[i]);
  }
  shade_glass(plan, paths.state(), {0, kPaths});
  int wrong = 0, refracted = 0;
  for (uint32_t i = 0; i < kPaths; ++i) {
    using Vec = reference::Vec3<double>;
    const Path<float> after = load_path<float>(paths.state(), i);
    const Arrival a = arrival(plan, before[i]);
    const Vec d(before[i].d_x, before[i].d_y, before[i].d_z), s(before[i].s_x, before[i].s_y, before[i].s_z);
    const Vec wi(after.d_x, after.d_y, after.d_z);
    wrong += !(std::abs(glm::length(wi) - 1) < 2.4e-7) || after.pdf != 0;
    if (glm::dot(wi, s) * glm::dot(d, s) > 0) {
      ++refracted;
      wrong += !(glm::length(glm::cross(a.n_i * d - a.n_t * wi, s)) < 2e-6);
      wrong += !(std::abs(after.beta_b / before[i].beta_b / (a.n_i * a.n_i / (a.n_t * a.n_t)) - 1) < 1e-6);
      wrong += a.u < a.reflectance - 1e-5;
    } else {
      wrong += !(glm::length(glm::cross(d - wi, s)) < 2e-6);
      wrong += after.beta_b != before[i].beta_b * 0.9f;
      wrong += a.u > a.reflectance + 1e-5 && a.g2 > 1e-5;
    }
  }
  CHECK(wrong == 0);
  CHECK(refracted > 1000);
}

TEST_CASE("shade_glass: index 1 is not there") {
  const Plan plan = test::material_plan({test::glass(1)});
  std::mt19937 rng(9);
  for (int i = 0; i < 100; ++i) {
    PathBuffer paths(kLanes);
    Path<float> p;
    test::fill_random(plan, rng, p, 0);
    store_path(paths.state(), 0, p);
    shade_glass(plan, paths.state(), {0, 1});
    const Path<float> after = load_path<float>(paths.state(), 0);
    CHECK(after.beta_r == p.beta_r);
    CHECK(std::abs(after.d_x - p.d_x) + std::abs(after.d_y - p.d_y) + std::abs(after.d_z - p.d_z) < 1e-6);
  }
}

}  // namespace lanewise
