#include "kernels/reference/shade_microfacet.h"

#include <doctest/doctest.h>

#include "tests/kernel_harness.h"
#include "tests/shading_harness.h"

namespace lanewise {
namespace {

using Vec = reference::Vec3<double>;
constexpr BsdfSampling kStrategies[] = {BsdfSampling::kVndf, BsdfSampling::kNdf, BsdfSampling::kCosine};

Settings with(BsdfSampling strategy, Direct direct = Direct::kMis, Fresnel fresnel = Fresnel::kExact) {
  Settings settings;
  settings.bsdf_sampling = strategy;
  settings.direct = direct;
  settings.fresnel = fresnel;
  return settings;
}

// Random arrivals, some grazing and some straight.
void awkward(std::mt19937& rng, Path<float>& p) {
  const float cosines[] = {1, -1, 1.7e-4f, -1.7e-4f, 0.02f, 0.5f, -0.7f, 0.95f};
  test::arrive(rng, p, cosines[rng() % 8]);
  if (rng() % 8 == 0) p.beta_r = p.beta_g = p.beta_b = 0;
}

// As `awkward`, with the light near the mirror direction, where all the reflection of a narrow lobe is.
void awkward_light(std::mt19937& rng, Path<float>& p, double spread) {
  awkward(rng, p);
  std::normal_distribution<double> normal;
  const Vec d(p.d_x, p.d_y, p.d_z), s(p.s_x, p.s_y, p.s_z);
  const Vec l = 0.7 * (d - 2 * glm::dot(d, s) * s + spread * Vec(normal(rng), normal(rng), normal(rng)));
  p.l_x = static_cast<float>(l.x), p.l_y = static_cast<float>(l.y), p.l_z = static_cast<float>(l.z);
  if (rng() % 8 == 0) p.l_x = p.l_y = p.l_z = p.l_pdf = 0;
}

}  // namespace

TEST_CASE("shade_microfacet: SIMD against its twin for every strategy, Fresnel model and roughness") {
  for (const BsdfSampling strategy : kStrategies) {
    for (const Fresnel fresnel : {Fresnel::kExact, Fresnel::kSchlick, Fresnel::kCourse}) {
      const Settings settings = with(strategy, Direct::kMis, fresnel);
      const Plan rough =
          test::material_plan({test::gold(0.1f), test::gold(0.4f), test::gold(1), test::white_metal(0.3f)}, settings);
      test::check_kernel(rough, "shade_microfacet");
      test::check_kernel(rough, "shade_microfacet", {}, awkward);
    }
    const Plan polished =
        test::material_plan({test::gold(1e-2f), test::gold(1e-3f), test::gold(1e-4f)}, with(strategy));
    test::check_kernel(polished, "shade_microfacet");
    test::check_kernel(polished, "shade_microfacet", {}, awkward);
  }
}

TEST_CASE("light_microfacet: SIMD against its twin for every strategy and use of light samples") {
  for (const BsdfSampling strategy : kStrategies) {
    for (const Direct direct : {Direct::kMis, Direct::kLight, Direct::kHemisphere}) {
      Settings settings = with(strategy, direct);
      settings.light_samples = 2;
      const Plan rough =
          test::material_plan({test::gold(0.1f), test::gold(0.4f), test::gold(1), test::white_metal(0.3f)}, settings);
      test::check_kernel(rough, "light_microfacet");
      test::check_kernel(rough, "light_microfacet", {},
                         [](std::mt19937& rng, Path<float>& p) { awkward_light(rng, p, 0.2); });
    }
  }
}

TEST_CASE("light_microfacet: polished metal stays finite and near the oracle where a float direction can tell") {
  const Plan plan = test::material_plan({test::gold(1e-3f), test::gold(1e-4f), test::gold(1e-5f), test::gold(0)},
                                        with(BsdfSampling::kVndf, Direct::kLight));
  std::mt19937 rng(11);
  test::for_each_target([&](const std::string& target) {
    CAPTURE(target);
    PathBuffer paths(2048);
    std::vector<Path<float>> before(2048);
    for (uint32_t i = 0; i < 2048; ++i) {
      test::fill_random(plan, rng, before[i], i);
      awkward_light(rng, before[i], i % 2 ? 1e-3 : 1e-5);
      store_path(paths.state(), i, before[i]);
    }
    light_microfacet(plan, paths.state(), {0, 2048});
    int bad = 0, far = 0, bright = 0;
    for (uint32_t i = 0; i < 2048; ++i) {
      const float c = paths.state().c_r[i];
      bad += !std::isfinite(c) || c < 0;
      // At alpha 1e-3 and away from grazing a float direction's slope is good to some 1e-4 of the lobe's width.
      const double cosine = glm::dot(LANEWISE_VEC3(before[i], d), LANEWISE_VEC3(before[i], s));
      if (before[i].prim != 0 || std::abs(cosine) < 0.01) continue;
      Path<double> p = load_path<double>(paths.state(), i);
      reference::light_microfacet(plan, p);
      bright += p.c_r > 1e-3;
      far += std::abs(c - p.c_r) > 0.02 * p.c_r + 1e-3;
    }
    CHECK(bad == 0);
    CHECK(bright > 50);
    CHECK(far == 0);
  });
}

TEST_CASE("shade_microfacet: the pdf written is the density that light samples are weighed against") {
  constexpr uint32_t kPaths = 2048;
  for (const BsdfSampling strategy : kStrategies) {
    for (const float alpha : {0.2f, 0.8f}) {
      const Plan plan = test::material_plan({test::gold(alpha)}, with(strategy));
      for (const double cosine : {1.0, 0.6, 0.1}) {
        PathBuffer paths(kPaths);
        test::fill_alike(paths, kPaths, cosine);
        const PathState& s = paths.state();
        shade_microfacet(plan, s, {0, kPaths});
        double worst = 0;
        for (uint32_t i = 0; i < kPaths; ++i) {
          if (s.beta_r[i] == 0 || s.d_z[i] < 1e-3f) continue;
          const Vec wo(std::sqrt(1 - cosine * cosine), 0, cosine), wi(s.d_x[i], s.d_y[i], s.d_z[i]);
          const auto pair = reference::evaluate_microfacet<double>(with(strategy), wo, wi, alpha);
          worst = std::max(worst, std::abs(s.pdf[i] / pair.pdf - 1));
          // beta = f cos / pdf, whatever the closed form it comes from.
          const double f = reference::fresnel_conductor(Fresnel::kExact, pair.cos_h, 0.21646, 3.2390);
          worst = std::max(worst, std::abs(s.beta_r[i] / (f * pair.f_cos / pair.pdf) - 1));
        }
        CAPTURE(alpha);
        CAPTURE(cosine);
        CHECK(worst < 1e-3);
      }
    }
  }
}

TEST_CASE("shade_microfacet: roughness 0 is the mirror, met continuously") {
  constexpr uint32_t kPaths = 256;
  for (const double cosine : {1.0, 0.6, 0.05}) {
    double last = 1;
    for (const float alpha : {1e-3f, 1e-4f, 1e-5f, 1e-6f, 0.0f}) {
      const Plan plan = test::material_plan({test::white_metal(alpha)});
      PathBuffer paths(kPaths);
      test::fill_alike(paths, kPaths, cosine);
      const PathState& s = paths.state();
      shade_microfacet(plan, s, {0, kPaths});
      double spread = 0, least = 1;
      for (uint32_t i = 0; i < kPaths; ++i) {
        const Vec wi(s.d_x[i], s.d_y[i], s.d_z[i]), mirror(-std::sqrt(1 - cosine * cosine), 0, cosine);
        spread += glm::length(wi - mirror) / kPaths;
        least = std::min(least, double(s.beta_r[i]));
        CHECK_UNARY(std::isfinite(s.pdf[i] * s.pdf[i]));
      }
      CAPTURE(alpha);
      CHECK(spread < 4 * alpha + 1e-5);
      CHECK(spread <= last);
      CHECK(least > 0.99);
      last = spread;
    }
  }
}

TEST_CASE("shade_microfacet: visible normals waste nothing where all normals waste much") {
  // At 85 degrees and alpha .25 four in ten samples of D fall below the surface or face away, and weights reach 7
  // (Heitz & d'Eon 2014); those of visible normals never exceed 1.
  constexpr uint32_t kPaths = 1 << 14;
  double lost[2], most[2];
  for (int k = 0; k < 2; ++k) {
    const Plan plan = test::material_plan({test::white_metal(0.25f)}, with(kStrategies[k]));
    PathBuffer paths(kPaths);
    test::fill_alike(paths, kPaths, std::cos(85 * std::numbers::pi / 180));
    shade_microfacet(plan, paths.state(), {0, kPaths});
    lost[k] = most[k] = 0;
    for (uint32_t i = 0; i < kPaths; ++i) {
      lost[k] += (paths.state().beta_r[i] == 0 ? 1.0 : 0.0) / kPaths;
      most[k] = std::max(most[k], double(paths.state().beta_r[i]));
    }
  }
  CHECK(lost[0] < 0.05);
  CHECK(lost[1] == doctest::Approx(0.41).epsilon(0.05));
  CHECK(most[0] <= 1 + 1e-6);
  CHECK(most[1] > 4);
}

}  // namespace lanewise
