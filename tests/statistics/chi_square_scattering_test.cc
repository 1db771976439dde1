// Directions of the scattering kernels against the densities that light samples are weighed with.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "kernels/reference/shade_microfacet.h"
#include "tests/kernel_harness.h"
#include "tests/shading_harness.h"
#include "tests/statistics/chi_square.h"
#include "tests/statistics/lobes.h"

TEST_SUITE_BEGIN("statistics");

namespace lanewise {
namespace {

using namespace test::lobes;
using std::numbers::pi;

double directions_p(const test::Domain& domain, Kernel kernel, const Plan& plan, const Arrival& arrival,
                    uint32_t draws) {
  test::ChiSquare test(domain);
  test::for_each_draw(kernel, plan, arrival.path, draws, [&](const PathState& s, uint32_t i) {
    const Vec w = arrival.next(s, i);
    s.pdf[i] > 0 ? test.add(std::max(w.z, 0.0) * w.z, std::atan2(w.y, w.x)) : test.add_void();
  });
  return test.p();
}

double lobe_p(BsdfSampling strategy, float alpha, const Arrival& arrival, uint64_t seed, uint32_t draws) {
  Settings settings;
  settings.bsdf_sampling = strategy;
  settings.seed = seed;
  const Plan plan = test::material_plan({test::white_metal(alpha)}, settings);
  test::ChiSquare test(
      lobe(arrival.wo, alpha, [&](const Vec& wi) { return evaluate(strategy, arrival.wo, wi, alpha).pdf; }));
  test::for_each_draw(shade_microfacet, plan, arrival.path, draws, [&](const PathState& s, uint32_t i) {
    const Vec h = arrival.wo + arrival.next(s, i);
    s.pdf[i] > 0 ? test.add(h.x / h.z / alpha, h.y / h.z / alpha) : test.add_void();
  });
  return test.p();
}

std::string named(const char* what, double alpha, double degrees) {
  return std::string(what) + ", alpha " + std::to_string(alpha) + ", " + std::to_string(degrees) + " degrees";
}

constexpr double kAngles[] = {0, 20, 45, 70, 85, 89, 89.9};

}  // namespace

TEST_CASE("chi-square: diffuse directions on every target") {
  test::Family family;
  test::for_each_target([&](const char* target) {
    for (const Vec& normal : {kUp, kTilted, kDown}) {
      for (const double degrees : {0.0, 60.0, 120.0}) {  // the last from behind
        Settings settings;
        settings.seed = family.tests();
        const Plan plan = test::material_plan({test::grey(1)}, settings);
        Arrival arrival(normal, degrees);
        if (degrees > 90) arrival.x = -arrival.x, arrival.z = -arrival.z;
        const test::Domain domain = hemisphere([](const Vec& w) { return w.z / pi; });
        family.add(target, directions_p(domain, shade_diffuse, plan, arrival, test::kDraws / 4));
        double worst = 0;
        test::for_each_draw(shade_diffuse, plan, arrival.path, 1000, [&](const PathState& s, uint32_t i) {
          worst = std::max(worst, std::abs(s.pdf[i] - arrival.next(s, i).z / pi));
        });
        CHECK(worst < 1e-7);
      }
    }
  });
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

TEST_CASE("chi-square: microfacets by visible and by all normals, every roughness and angle") {
  test::Family family;
  for (const BsdfSampling strategy : {BsdfSampling::kVndf, BsdfSampling::kNdf}) {
    const char* name = strategy == BsdfSampling::kVndf ? "visible normals" : "normals";
    for (const float alpha : {1e-4f, 1e-3f, 1e-2f, 0.1f, 0.3f, 1.0f}) {
      for (const double degrees : kAngles) {
        const double p = lobe_p(strategy, alpha, Arrival(kUp, degrees), family.tests(), test::kDraws);
        family.add(named(name, alpha, degrees), p);
      }
    }
  }
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

TEST_CASE("chi-square: microfacets on every target, normals of any direction") {
  test::Family family;
  test::for_each_target([&](const char* target) {
    for (const BsdfSampling strategy : {BsdfSampling::kVndf, BsdfSampling::kNdf}) {
      for (const Vec& normal : {kTilted, kDown}) {
        const double p = lobe_p(strategy, 0.4f, Arrival(normal, 75), 1000 + family.tests(), test::kDraws);
        family.add(target, p);
      }
    }
  });
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

TEST_CASE("chi-square: microfacets by the cosine") {
  test::Family family;
  for (const float alpha : {1e-4f, 0.1f, 1.0f}) {
    for (const double degrees : kAngles) {
      Settings settings;
      settings.bsdf_sampling = BsdfSampling::kCosine;
      settings.seed = family.tests();
      const Plan plan = test::material_plan({test::white_metal(alpha)}, settings);
      const Arrival arrival(kUp, degrees);
      const test::Domain domain =
          hemisphere([&](const Vec& wi) { return evaluate(BsdfSampling::kCosine, arrival.wo, wi, alpha).pdf; });
      family.add(named("cosine", alpha, degrees),
                 directions_p(domain, shade_microfacet, plan, arrival, test::kDraws / 4));
    }
  }
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

TEST_CASE("chi-square: glass reflects as often as Fresnel says, on every target") {
  test::Family family;
  test::for_each_target([&](const char* target) {
    for (const Fresnel fresnel : {Fresnel::kExact, Fresnel::kSchlick, Fresnel::kCourse}) {
      for (const double degrees : {0.0, 50.0, 80.0, 89.0, 160.0, 139.0}) {
        Settings settings;
        settings.fresnel = fresnel;
        settings.seed = family.tests();
        const Plan plan = test::material_plan({test::glass(1.45f)}, settings);
        const Arrival arrival(kTilted, degrees);
        const double cosine = std::abs(arrival.wo.z);
        const double share = degrees < 90
                                 ? reference::fresnel_dielectric(fresnel, cosine, 1.0, double(1.45f)).reflectance
                                 : reference::fresnel_dielectric(fresnel, cosine, double(1.45f), 1.0).reflectance;
        double counts[2] = {0, 0};
        constexpr uint32_t kDraws = test::kDraws / 4;
        test::for_each_draw(shade_glass, plan, arrival.path, kDraws, [&](const PathState& s, uint32_t i) {
          ++counts[arrival.next(s, i).z * arrival.wo.z > 0 ? 0 : 1];
        });
        const double expected[2] = {share * kDraws, (1 - share) * kDraws};
        family.add(target + named("", int(fresnel), degrees), test::chi_square_p(counts, expected));
      }
    }
  });
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

}  // namespace lanewise

TEST_SUITE_END();
