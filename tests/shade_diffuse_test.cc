#include "kernels/reference/shade_diffuse.h"

#include <doctest/doctest.h>

#include "kernels/reference/sample_hemisphere.h"
#include "tests/kernel_harness.h"
#include "tests/shading_harness.h"

namespace lanewise {
namespace {

// Grazing and straight arrivals, on either side, and light samples in the surface's plane, of no length or of no use.
void awkward(std::mt19937& rng, Path<float>& p) {
  const float cosines[] = {1, -1, 1.7e-4f, -1.7e-4f, 0.5f, -0.5f};
  test::arrive(rng, p, cosines[rng() % 6]);
  switch (rng() % 4) {
    case 0:
      p.l_x = p.l_y = p.l_z = 0, p.l_pdf = 0;
      break;
    case 1:
      p.l_x = 1e6f * p.s_x, p.l_y = 1e6f * p.s_y, p.l_z = 1e6f * p.s_z, p.l_pdf = 1e12f;
      break;
    case 2:
      p.beta_r = p.beta_g = p.beta_b = 0;
      break;
    default:
      break;
  }
}

Plan greys(const Settings& settings = {}) {
  return test::material_plan({test::grey(0), test::grey(0.6f), test::grey(1)}, settings);
}

}  // namespace

TEST_CASE("shade_diffuse, light_diffuse: SIMD against their twins") {
  test::check_kernel(test::test_plan(), "shade_diffuse");
  test::check_kernel(greys(), "shade_diffuse", {}, awkward);
  for (const Direct direct : {Direct::kMis, Direct::kLight, Direct::kHemisphere}) {
    Settings settings;
    settings.direct = direct;
    settings.light_samples = 3;
    test::check_kernel(test::test_plan(settings), "light_diffuse");
    test::check_kernel(greys(settings), "light_diffuse", {}, awkward);
  }
}

TEST_CASE("sample_hemisphere: SIMD against its twin") {
  const Step step = {.bounce = 2, .light = 0, .light_sample = 1};
  test::check_kernel(test::test_plan(), "sample_hemisphere", step, awkward);
}

TEST_CASE("light_diffuse: MIS weights of both strategies sum to one") {
  // With f cos = albedo pdf, the light's estimate over albedo radiance is pdf / (n l_pdf) times its weight.
  Settings settings;
  settings.light_samples = 4;
  const Plan plan = test::material_plan({test::grey(1)}, settings);
  for (const double l_pdf : {1e-3, 0.1, 3.0, 1e4}) {
    Path<double> p;
    p.d_z = -1, p.s_z = 1, p.l_z = 2, p.l_x = 1;
    p.beta_r = 1, p.l_pdf = l_pdf;
    reference::light_diffuse(plan, p);
    const double pdf = 2 / std::sqrt(5.0) * std::numbers::inv_pi, n_pdf = 4 * l_pdf;
    const double bsdf_weight = pdf * pdf / (pdf * pdf + n_pdf * n_pdf);
    CHECK(p.c_r / 20 / pdf * n_pdf + bsdf_weight == doctest::Approx(1));
  }
}

}  // namespace lanewise
