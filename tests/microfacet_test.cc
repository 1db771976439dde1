#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/microfacet_test.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/microfacet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// n is a multiple of kLanes in all.
void Distributions(const float* tan2, const float* alpha, size_t n, float* d) {
  const DF df;
  for (size_t i = 0; i < n; i += hn::Lanes(df)) {
    hn::StoreU(BeckmannD(hn::LoadU(df, tan2 + i), hn::LoadU(df, alpha + i)), df, d + i);
  }
}

// The slope for uniform number u seen at this cosine and sine, and G1 there.
void VisibleSlopes(const float* cosine, const float* sine, const float* alpha, const float* u, size_t n, float* x,
                   float* g1) {
  const DF df;
  for (size_t i = 0; i < n; i += hn::Lanes(df)) {
    const SlopeView v = ViewSlopes(hn::LoadU(df, cosine + i), hn::LoadU(df, sine + i), hn::LoadU(df, alpha + i));
    hn::StoreU(SampleVisibleSlope(v, hn::LoadU(df, u + i)), df, x + i);
    hn::StoreU(SmithG1(v), df, g1 + i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "kernels/reference/microfacet.h"
#include "tests/kernel_harness.h"

namespace lanewise {
namespace {

HWY_EXPORT(Distributions);
HWY_EXPORT(VisibleSlopes);

float beckmann_d(double tan2, double alpha) {
  const std::vector<float> t(kLanes, static_cast<float>(tan2)), a(kLanes, static_cast<float>(alpha));
  std::vector<float> d(kLanes);
  HWY_DYNAMIC_DISPATCH(Distributions)(t.data(), a.data(), kLanes, d.data());
  return d[0];
}

struct SurfaceView {
  double theta, alpha;
};

struct Slopes {
  std::vector<float> x, g1;
};

Slopes visible_slopes(const SurfaceView& view, const std::vector<float>& u) {
  const size_t n = round_up_to_lanes(static_cast<uint32_t>(u.size()));
  std::vector<float> padded = u;
  padded.resize(n, 0.5f);
  const std::vector<float> c(n, static_cast<float>(std::cos(view.theta))),
      s(n, static_cast<float>(std::sin(view.theta)));
  const std::vector<float> alpha(n, static_cast<float>(view.alpha));
  Slopes out{std::vector<float>(n), std::vector<float>(n)};
  HWY_DYNAMIC_DISPATCH(VisibleSlopes)
  (c.data(), s.data(), alpha.data(), padded.data(), n, out.x.data(), out.g1.data());
  return out;
}

constexpr double kDegree = std::numbers::pi / 180;

// 1 / (1 + Lambda) as Walter et al. write it.
double smith_g1(double theta, double alpha) {
  const double a = 1 / (alpha * std::tan(theta));
  return 2 / (1 + std::erf(a) + std::exp(-a * a) / (a * std::sqrt(std::numbers::pi)));
}

// Of the share of visible slopes below x and of that above it, each without the other's rounding.
struct Shares {
  double below, above;
};

Shares shares(double cosine, double sine, double alpha, double x) {
  const reference::SlopeView<double> v(cosine, sine, alpha);
  const double e = v.s / 2 * std::exp(-x * x);
  const double end = v.half * std::erfc(v.cut) - v.s / 2 * std::exp(-v.cut * v.cut);
  return {(v.half * std::erfc(-x) + e) / v.area, (v.half * std::erfc(x) - e - end) / v.area};
}

std::vector<float> uniforms() {
  std::vector<float> u;
  for (int k = 0; k < 40; ++k)
    u.push_back(static_cast<float>(k) * 0x1p-24f), u.push_back(1 - static_cast<float>(k + 1) * 0x1p-24f);
  for (int e = 2; e < 24; ++e) u.push_back(std::ldexp(1.0f, -e)), u.push_back(1 - std::ldexp(1.0f, -e));
  for (int k = 1; k < 500; ++k) u.push_back(static_cast<float>(k) / 500);
  return u;
}

}  // namespace

TEST_CASE("microfacet: D at theta = alpha is right for small alpha, where tan^2 from the cosine is not") {
  test::for_each_target([&](const std::string& target) {
    CAPTURE(target);
    for (const double alpha : {1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5}) {
      CAPTURE(alpha);
      const double tan2 = std::tan(alpha) * std::tan(alpha), c2 = std::cos(alpha) * std::cos(alpha);
      const double want = std::exp(-tan2 / (alpha * alpha)) / (std::numbers::pi * alpha * alpha * c2 * c2);
      CHECK(beckmann_d(tan2, alpha) == doctest::Approx(want).epsilon(2e-6));
    }
    for (const double alpha : {1e-3, 1e-4}) {
      const float cosine = static_cast<float>(std::cos(alpha));
      const float naive_tan2 = (1 - cosine * cosine) / (cosine * cosine);
      const double error = std::exp(-naive_tan2 / (alpha * alpha)) / std::exp(-1.0) - 1;
      CHECK(std::abs(error) > 0.03);
    }
    CHECK(beckmann_d(0, 1e-4) == doctest::Approx(1 / (std::numbers::pi * 1e-8)).epsilon(1e-6));
    CHECK(beckmann_d(4e12, 1e-6) == 0);
    CHECK(std::isfinite(beckmann_d(4e12, 10)));
  });
}

TEST_CASE("microfacet: D projects to unit area") {
  for (const double alpha : {1e-4, 0.05, 0.5, 2.0}) {
    // Over t = tan^2 = alpha^2 x: D cos dw = e^(-x) (alpha q)^2 ... the integral of e^(-x) over x.
    double sum = 0;
    constexpr int kSteps = 4000;
    for (int i = 0; i < kSteps; ++i) {
      const double x = (i + 0.5) * 40 / kSteps, tan2 = alpha * alpha * x, c2 = 1 / (1 + tan2);
      // dw = 2 pi sin dtheta = pi c^3 dtan2.
      sum += beckmann_d(tan2, alpha) * c2 * c2 * std::numbers::pi * alpha * alpha * 40 / kSteps;
    }
    CHECK(sum == doctest::Approx(1).epsilon(1e-4));
  }
}

TEST_CASE("microfacet: G1 is Smith's exact one, at most 1, and finite at grazing angles") {
  test::for_each_target([&](const std::string& target) {
    CAPTURE(target);
    double worst = 0;
    for (const double alpha : {1e-5, 1e-3, 0.05, 0.25, 0.5, 1.0, 3.0}) {
      for (double degrees = 0.01; degrees < 90; degrees += 0.37) {
        const double theta = degrees * kDegree;
        const float g1 = visible_slopes({theta, alpha}, {0.5f}).g1[0];
        // Against the angle that the float cosine and sine stand for.
        const double seen =
            std::atan2(double(static_cast<float>(std::sin(theta))), double(static_cast<float>(std::cos(theta))));
        worst = std::max(worst, std::abs(g1 - smith_g1(seen, static_cast<float>(alpha))));
        CHECK_UNARY(g1 <= 1.0000005f);
      }
    }
    CHECK(worst < 1e-6);
    CHECK(visible_slopes({85 * kDegree, 0.5}, {0.5f}).g1[0] == doctest::Approx(0.463).epsilon(0.002));
  });
}

TEST_CASE("microfacet: visible slopes invert their distribution at every angle and in both tails") {
  const std::vector<float> u = uniforms();
  test::for_each_target([&](const std::string& target) {
    CAPTURE(target);
    double worst = 0, worst_tail = 0;
    SurfaceView at{0, 0};
    float at_u = 0;
    for (const double alpha : {1e-5, 1e-3, 0.05, 0.3, 1.0, 3.0}) {
      for (const double degrees :
           {0.0, 0.01, 1.0, 20.0, 45.0, 60.0, 70.0, 80.0, 85.0, 88.0, 89.0, 89.9, 89.99, 89.9999}) {
        const SurfaceView view{degrees * kDegree, alpha};
        const Slopes out = visible_slopes(view, u);
        const double c = static_cast<float>(std::cos(view.theta)), s = static_cast<float>(std::sin(view.theta));
        for (size_t i = 0; i < u.size(); ++i) {
          const double want = std::max(u[i], 0x1p-25f);
          const Shares got = shares(c, s, static_cast<float>(alpha), out.x[i]);
          const double error = want < 0.5 ? std::abs(got.below - want) : std::abs(got.above - (1 - want));
          if (!(error <= worst)) worst = error, at = view, at_u = u[i];
          // Relative to the tail. Near the cut, where the density is 0, the last bits of a slope tell nothing apart.
          const double slack = want < 0.5 ? 0 : 3e-7;
          worst_tail = std::max(worst_tail, (error - slack) / std::min(want, 1 - want));
        }
      }
    }
    CAPTURE(at.theta / kDegree);
    CAPTURE(at.alpha);
    CAPTURE(at_u);
    CHECK(worst < 1e-6);
    CHECK(worst_tail < 2e-5);
  });
}

TEST_CASE("microfacet: the twin's slopes agree in float and double") {
  double worst = 0;
  for (const double alpha : {1e-4, 0.3, 1.0}) {
    for (const double degrees : {0.0, 30.0, 80.0, 89.9}) {
      for (const double u : {0.0, 1e-3, 0.2, 0.5, 0.9, 0.999}) {
        const double c = std::cos(degrees * kDegree), s = std::sin(degrees * kDegree);
        const double exact = reference::visible_slope(reference::SlopeView<double>(c, s, alpha), u);
        const float single = reference::visible_slope(
            reference::SlopeView<float>(static_cast<float>(c), static_cast<float>(s), static_cast<float>(alpha)),
            static_cast<float>(u));
        worst = std::max(worst, std::abs(exact - single));
        const Shares got = shares(c, s, alpha, exact);
        CHECK(std::abs(got.below - std::max(u, 0x1p-25)) < 1e-13);
      }
    }
  }
  CHECK(worst < 2e-5);
}

}  // namespace lanewise
#endif
