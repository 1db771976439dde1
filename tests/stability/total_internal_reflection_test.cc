// At the critical angle sin^2 of the refracted ray is 1, and one rounding error, or a fused multiply-add on one machine
// and not on the other, decides whether a ray is refracted at all. That does no harm if the reflectance meets 1 there.
#include <doctest/doctest.h>

#include <cmath>

#include "core/verify/exact_functions.h"
#include "tests/fresnel_harness.h"
#include "tests/kernel_harness.h"
#include "tests/stability/curve.h"

namespace lanewise {
namespace {

constexpr float kIndex = 1.5f;
constexpr int kBand = 32;  // floats to either side of the critical cosine

// As the course program does it: a test of the sine, then Schlick of the cosine of incidence.
float naive_reflectance(float c, float index) {
  const float sin2_t = index * index * (1 - c * c);
  if (sin2_t > 1) return 1;
  const float root = (1 - index) / (1 + index), f0 = root * root, m = 1 - c;
  return f0 + (1 - f0) * m * m * m * m * m;
}

double exact_reflectance(double c, double index) {
  return index * index * (1 - c * c) >= 1 ? 1 : verify::fresnel_equations(c, 1 / index);
}

// The cosines up to `band` floats to either side of the critical one, from total reflection on.
std::vector<float> critical_band(float index, int band) {
  float c = static_cast<float>(std::sqrt(1 - 1 / (double(index) * index)));
  for (int i = 0; i < band; ++i) c = std::nextafter(c, 0.0f);
  std::vector<float> cosines;
  for (int i = -band; i <= band; ++i, c = std::nextafter(c, 1.0f)) cosines.push_back(c);
  return cosines;
}

}  // namespace

TEST_SUITE_BEGIN("stability");

TEST_CASE("stability: reflectance at the critical angle") {
  test::Curve curve{.name = "total-internal-reflection",
                    .title = "Reflectance around the critical angle of glass",
                    .naive = "Schlick of the incident cosine (course)",
                    .ours = "exact, factored (default)",
                    .x_axis = "distance to the critical cosine (ulp; below 0: total reflection)",
                    .y_axis = "absolute error of F",
                    .log_x = false};
  test::FresnelInputs in;
  for (const float c : critical_band(kIndex, kBand)) {
    in.add(c, kIndex, 1);
    const double naive = std::abs(naive_reflectance(c, kIndex) - exact_reflectance(c, kIndex));
    curve.points.push_back({double(curve.points.size()) - kBand, naive, 0});
  }
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    for (const Fresnel model : {Fresnel::kExact, Fresnel::kSchlick}) {
      CAPTURE(int(model));
      const test::DielectricOutputs out = test::dielectrics(model, in);
      double step = 0;
      for (size_t i = 0; i < curve.points.size(); ++i) {
        if (i > 0) test::take_worst(step, std::abs(double(out.f[i]) - double(out.f[i - 1])));
        if (int(i) < kBand - 4) CHECK(out.f[i] == 1);
        if (model != Settings().fresnel) continue;
        test::take_worst(curve.points[i].ours, std::abs(out.f[i] - exact_reflectance(in.c[i], kIndex)));
      }
      CHECK(step < 5e-3);
    }
  });
  CHECK(curve.worst_naive() > 0.9);  // the step of the naive form
  CHECK(curve.worst_ours() < 3e-3);
  test::record(curve);
}

TEST_CASE("stability: a fused multiply-add decides on total reflection, not on the reflectance") {
  test::FresnelInputs in;
  uint32_t flips = 0;
  double naive = 0;
  for (float index = 1.1f; index < 2.5f; index += 0.001f) {
    for (const float c : critical_band(index, 4)) {
      in.add(c, index, 1);
      const float ratio2 = index * index;
      const bool plain = ratio2 * (1 - c * c) > 1, fused = ratio2 * std::fma(-c, c, 1.0f) > 1;
      if (plain == fused) continue;
      // Total reflection for the one, Schlick's few percent for the other.
      ++flips;
      test::take_worst(naive, 1 - double(naive_reflectance(std::nextafter(c, 1.0f), index)));
    }
  }
  double ours = 0;
  std::vector<float> first;
  test::for_each_target([&](const char*) {  // some fuse, some do not
    const std::vector<float> f = test::dielectrics(Settings().fresnel, in).f;
    if (first.empty()) first = f;
    for (size_t i = 0; i < in.c.size(); ++i) test::take_worst(ours, std::abs(double(f[i]) - double(first[i])));
  });
  CHECK(flips > 0);
  CHECK(naive > 0.9);
  CHECK(ours < 0.02);
}

TEST_SUITE_END();

}  // namespace lanewise
