// Light may be followed either way: f(wo, wi) = f(wi, wo), and through glass L / n^2 is what is carried.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "kernels/reference/shade_diffuse.h"
#include "tests/kernel_harness.h"
#include "tests/shading_harness.h"
#include "tests/statistics/lobes.h"

TEST_SUITE_BEGIN("statistics");

namespace lanewise {
namespace {

using namespace test::lobes;

constexpr uint32_t kPairs = 1024;

Vec random_direction(std::mt19937& rng) {
  std::uniform_real_distribution<double> unit(0, 1);
  return reference::uniform_hemisphere(unit(rng), unit(rng));
}

// A path that comes from wo and has its light in direction wi.
Path<float> lit_path(const Vec& wo, const Vec& wi, uint32_t prim) {
  Path<float> p;
  LANEWISE_SET_VEC3(p, d, glm::vec3(-wo));
  LANEWISE_SET_VEC3(p, l, glm::vec3(2.0 * wi));
  p.n_z = p.s_z = 1;
  p.beta_r = p.beta_g = p.beta_b = 1;
  p.l_pdf = 1;
  p.prim = prim;
  return p;
}

// f of wi given wo, per light sample of radiance 1 in the third channel.
double f_of(const PathState& s, uint32_t i) {
  const Vec l(s.l_x[i], s.l_y[i], s.l_z[i]);
  return s.c_b[i] / 5.0 / (l.z / glm::length(l));
}

// Largest |f(wo, wi) / f(wi, wo) - 1| over random pairs whose f is not next to nothing, on every target; cosines above 0.02.
double worst_pair(Kernel kernel, const Plan& plan) {
  double worst = 0;
  test::for_each_target([&](const char*) {
    std::mt19937 rng(17);
    PathBuffer there(kPairs), back(kPairs);
    for (uint32_t i = 0; i < kPairs; ++i) {
      Vec wo, wi;
      do wo = random_direction(rng), wi = random_direction(rng);
      while (wo.z < 0.02 || wi.z < 0.02);
      const uint32_t prim = i % plan.triangles;
      store_path(there.state(), i, lit_path(wo, wi, prim));
      store_path(back.state(), i, lit_path(wi, wo, prim));
    }
    kernel(plan, there.state(), {0, kPairs});
    kernel(plan, back.state(), {0, kPairs});
    uint32_t compared = 0;
    for (uint32_t i = 0; i < kPairs; ++i) {
      const double a = f_of(there.state(), i), b = f_of(back.state(), i);
      if (std::max(a, b) < 1e-3) continue;
      ++compared;
      worst = std::max(worst, std::abs(a / b - 1));
    }
    CHECK(compared > kPairs / 4);
  });
  return worst;
}

}  // namespace

TEST_CASE("reciprocity: diffuse and microfacets under every Fresnel model, on every target") {
  Settings settings;
  settings.direct = Direct::kLight;
  CHECK(worst_pair(light_diffuse, test::material_plan({test::grey(0.6f)}, settings)) < 1e-6);
  for (const Fresnel fresnel : {Fresnel::kExact, Fresnel::kSchlick, Fresnel::kCourse}) {
    settings.fresnel = fresnel;
    const Plan plan = test::material_plan({test::gold(0.1f), test::gold(0.4f), test::gold(1), test::gold(2)}, settings);
    CHECK(worst_pair(light_microfacet, plan) < 5e-5);
  }
}

TEST_CASE("reciprocity: the double twin's f to the last digits, down to alpha 1e-4") {
  std::mt19937 rng(23);
  std::normal_distribution<double> normal;
  double worst = 0;
  for (const double alpha : {1e-4, 1e-2, 0.3, 1.0}) {
    for (int i = 0; i < 10000; ++i) {
      // wi around wo's mirror direction, some alphas away.
      const Vec wo = random_direction(rng);
      const Vec wi = glm::normalize(Vec(-wo.x, -wo.y, wo.z) + alpha * Vec(normal(rng), normal(rng), normal(rng)));
      if (wi.z <= 0) continue;
      const double a = evaluate(BsdfSampling::kVndf, wo, wi, alpha).f,
                   b = evaluate(BsdfSampling::kVndf, wi, wo, alpha).f;
      if (std::max(a, b) > 1e-100) worst = std::max(worst, std::abs(a / b - 1));
    }
  }
  CHECK(worst < 1e-12);
}

TEST_CASE("reciprocity: glass, there and back again, on every target") {
  PlanMaterial clear = test::grey(1);
  clear.ior = 1.5f;
  const Plan plan = test::material_plan({clear});
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    for (const double degrees : {0.0, 30.0, 60.0, 85.0, 150.0, 160.0}) {
      CAPTURE(degrees);
      const Arrival arrival(kTilted, degrees);
      double worst_beta = 0, worst_d = 0;
      uint32_t returned = 0;
      PathBuffer back(kLanes);
      test::for_each_draw(shade_glass, plan, arrival.path, 256, [&](const PathState& s, uint32_t i) {
        if (arrival.next(s, i).z * arrival.wo.z > 0) return;  // reflected
        Path<float> p = load_path<float>(s, i);
        p.d_x = -p.d_x, p.d_y = -p.d_y, p.d_z = -p.d_z;
        store_path(back.state(), 0, p);
        shade_glass(plan, back.state(), {0, 1});
        const Path<float> end = load_path<float>(back.state(), 0);
        const Vec d(end.d_x, end.d_y, end.d_z), began(arrival.path.d_x, arrival.path.d_y, arrival.path.d_z);
        if (glm::dot(d, began) > 0) return;  // reflected inside
        ++returned;
        worst_beta = std::max(worst_beta, std::abs(end.beta_r - 1.0));
        worst_d = std::max(worst_d, glm::length(d + began));
      });
      CHECK(returned > 20);
      CHECK(worst_beta < 1e-6);
      CHECK(worst_d < 1e-5);
      // As much is reflected from either side.
      const double c = std::abs(arrival.wo.z), n_i = degrees < 90 ? 1 : 1.5, n_t = 2.5 - n_i;
      for (const Fresnel fresnel : {Fresnel::kExact, Fresnel::kSchlick}) {
        const auto in = reference::fresnel_dielectric(fresnel, c, n_i, n_t);
        const auto out = reference::fresnel_dielectric(fresnel, in.cos_t, n_t, n_i);
        CHECK(in.reflectance == doctest::Approx(out.reflectance).epsilon(1e-9));
        CHECK(out.cos_t == doctest::Approx(c).epsilon(1e-9));
      }
    }
  });
}

}  // namespace lanewise

TEST_SUITE_END();
