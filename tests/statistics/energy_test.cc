// White furnace of every BSDF: what it reflects of light from everywhere, sampled and integrated.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "tests/kernel_harness.h"
#include "tests/shading_harness.h"
#include "tests/statistics/lobes.h"

TEST_SUITE_BEGIN("statistics");

namespace lanewise {
namespace {

using namespace test::lobes;

constexpr double kAngles[] = {0, 30, 60, 80, 89, 89.9};

// Directional albedo without Fresnel: the integral of f cos over the hemisphere.
double albedo(const Vec& wo, double alpha) {
  return test::integrate(
      test::lobes::lobe(wo, alpha, [&](const Vec& wi) { return evaluate(BsdfSampling::kVndf, wo, wi, alpha).f_cos; }));
}

// Of the third channel, in which gold's reflectance depends most on the angle.
double gold_albedo(const Vec& wo, double alpha) {
  const PlanMaterial gold = test::gold(static_cast<float>(alpha));
  return test::integrate(test::lobes::lobe(wo, alpha, [&](const Vec& wi) {
    const auto pair = evaluate(BsdfSampling::kVndf, wo, wi, alpha);
    return pair.f_cos * reference::fresnel_conductor<double>(Fresnel::kExact, pair.cos_h, gold.eta[2], gold.k[2]);
  }));
}

// beta of the third channel after one scattering.
test::Moments weights(Kernel kernel, const Plan& plan, const Arrival& arrival, uint32_t draws) {
  test::Moments sample;
  test::for_each_draw(kernel, plan, arrival.path, draws,
                      [&](const PathState& s, uint32_t i) { sample.add(s.beta_b[i]); });
  return sample;
}

std::string named(const char* what, double alpha, double degrees) {
  return std::string(what) + ", alpha " + std::to_string(alpha) + ", " + std::to_string(degrees) + " degrees";
}

// Weights of cosine sampling have no bound that a mean of some thousands could be judged by where the lobe is narrow or
// the view grazes.
bool is_calm(BsdfSampling strategy, float alpha, double degrees) {
  return strategy != BsdfSampling::kCosine || (alpha >= 0.1f && degrees < 75);
}

}  // namespace

TEST_CASE("energy: microfacets reflect what f cos integrates to, by every strategy") {
  constexpr std::pair<BsdfSampling, const char*> kStrategies[] = {
      {BsdfSampling::kVndf, "visible normals"}, {BsdfSampling::kNdf, "normals"}, {BsdfSampling::kCosine, "cosine"}};
  test::Family family;
  for (const float alpha : {1e-4f, 1e-2f, 0.1f, 0.3f, 0.6f, 1.0f}) {
    for (const double degrees : kAngles) {
      const Arrival arrival(kUp, degrees);
      const double white = albedo(arrival.wo, alpha), gold = gold_albedo(arrival.wo, alpha);
      for (const auto& [strategy, name] : kStrategies) {
        if (!is_calm(strategy, alpha, degrees)) continue;
        Settings settings;
        settings.bsdf_sampling = strategy;
        settings.seed = family.tests();
        const Plan of_white = test::material_plan({test::white_metal(alpha)}, settings);
        const Plan of_gold = test::material_plan({test::gold(alpha)}, settings);
        const test::Moments white_sample = weights(shade_microfacet, of_white, arrival, test::kDraws / 8);
        const test::Moments gold_sample = weights(shade_microfacet, of_gold, arrival, test::kDraws / 8);
        family.add(named(name, alpha, degrees) + ", white", test::t_test_p(white_sample, white, 2e-6));
        family.add(named(name, alpha, degrees) + ", gold", test::t_test_p(gold_sample, gold, 2e-6));
      }
    }
  }
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

TEST_CASE("energy: white metal gives none, and loses what single scattering must") {
  for (const double degrees : kAngles) {
    const Vec wo = Arrival(kUp, degrees).wo;
    double last = 1 + 1e-5;
    for (const double alpha : {1e-4, 1e-3, 1e-2, 0.1, 0.3, 0.6, 1.0, 2.0}) {
      CAPTURE(alpha);
      CAPTURE(degrees);
      const double now = albedo(wo, alpha);
      CHECK(now <= 1 + 1e-5);
      if (degrees == 0) {  // rougher is darker at the normal
        CHECK(now <= last + 1e-9);
        last = now;
      }
      if (alpha == 1e-4) CHECK(now > 0.99);  // nearly the mirror
    }
  }
}

TEST_CASE("energy: diffuse reflects its albedo, mirror and glass all, exactly and on every target") {
  const Plan diffuse = test::material_plan({test::grey(0.7f)}), mirror = test::material_plan({test::grey(1)});
  PlanMaterial clear = test::grey(1);
  clear.ior = 1.5f;
  const Plan glass = test::material_plan({clear});
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    for (const double degrees : {0.0, 30.0, 60.0, 80.0, 89.0, 89.9, 110.0, 138.0, 150.0}) {
      CAPTURE(degrees);
      const Arrival arrival(kTilted, degrees);
      float least = 1, most = 0;
      test::for_each_draw(shade_diffuse, diffuse, arrival.path, 256, [&](const PathState& s, uint32_t i) {
        least = std::min(least, s.beta_r[i]), most = std::max(most, s.beta_r[i]);
      });
      CHECK(least == 0.7f);
      CHECK(most == 0.7f);
      test::for_each_draw(shade_mirror, mirror, arrival.path, 16,
                          [&](const PathState& s, uint32_t i) { CHECK_UNARY(s.beta_r[i] == 1.0f); });
      // Refracted radiance over the index squared is what is conserved.
      const double ratio = degrees < 90 ? 1.5 : 1 / 1.5;
      double worst = 0;
      test::for_each_draw(shade_glass, glass, arrival.path, 256, [&](const PathState& s, uint32_t i) {
        const bool refracted = arrival.next(s, i).z * arrival.wo.z < 0;
        worst = std::max(worst, std::abs(s.beta_r[i] * (refracted ? ratio * ratio : 1) - 1));
      });
      CHECK(worst < 3e-7);
    }
  });
}

TEST_CASE("energy: roulette keeps the mean, on every target") {
  test::Family family;
  const Plan plan = test::material_plan({test::grey(1)});
  test::for_each_target([&](const char* target) {
    for (const float beta : {0.01f, 0.3f, 0.9f, 1.0f, 3.0f}) {
      Path<float> path;
      path.beta_r = 0.5f * beta, path.beta_g = beta, path.beta_b = 0.25f * beta;
      path.step.bounce = kRouletteBounce + static_cast<uint32_t>(family.tests());
      test::Moments kept;
      test::for_each_draw(roulette, plan, path, test::kDraws / 4,
                          [&](const PathState& s, uint32_t i) { kept.add(s.beta_b[i]); });
      family.add(std::string(target) + " beta " + std::to_string(beta),
                 test::t_test_p(kept, 0.25 * double(beta), 1e-7 * double(beta)));
    }
  });
  CHECK_MESSAGE(family.holds(), family.least_likely());
}

}  // namespace lanewise

TEST_SUITE_END();
