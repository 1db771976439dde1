// Random numbers of different decisions: padding with the same set for two of them correlates what must be independent, and
// a low-discrepancy sequence that is only scrambled, not shuffled, stays correlated with its copies (Burley, Practical
// Hash-based Owen Scrambling, JCGT 9(4), 2020).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/stability/dimensions_test.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/rng-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// The four numbers of each (pixel[i], sample[i]), i < n: u[k][i]. n is a multiple of kLanes.
void Draw(Sampler sampler, const uint32_t* pixel, const uint32_t* sample, size_t n, uint32_t set, uint64_t seed,
          float* const (&u)[4]) {
  const DU d;
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    const Random4 random = DrawRandom(sampler, hn::LoadU(d, pixel + i), hn::LoadU(d, sample + i), set, seed);
    for (int k = 0; k < 4; ++k) hn::StoreU(random.u[k], DF(), u[k] + i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <doctest/doctest.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numeric>

#include "kernels/reference/rng.h"
#include "tests/kernel_harness.h"
#include "tests/stability/curve.h"
#include "tests/statistics/significance.h"

namespace lanewise {
namespace {

HWY_EXPORT(Draw);

// Whose numbers: `lag` shifts the sample, the rest are DrawRandom's.
struct Decision {
  std::string name;
  uint32_t pixel = 1000;
  uint32_t lag = 0;
  uint32_t set = random_set(2, kSetPath);
  uint64_t seed = 0;
  Sampler sampler = Sampler::kRandom;
};

using Numbers = std::array<std::vector<float>, 4>;

// Of samples 0 .. n - 1 of the decision's pixel.
Numbers draw(const Decision& of, size_t n) {
  std::vector<uint32_t> pixel(n, of.pixel), sample(n);
  std::iota(sample.begin(), sample.end(), of.lag);
  Numbers u;
  for (auto& v : u) v.resize(n);
  float* const out[4] = {u[0].data(), u[1].data(), u[2].data(), u[3].data()};
  HWY_DYNAMIC_DISPATCH(Draw)(of.sampler, pixel.data(), sample.data(), n, of.set, of.seed, out);
  return u;
}

double correlation(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (double{a[i]} - 0.5) * (double{b[i]} - 0.5);
  return 12 * sum / static_cast<double>(a.size());  // 1/12: the variance of a uniform number
}

// The p-value of "(a[i], b[i]) are uniform in the unit square" by 16 x 16 cells.
double uniform_p(const std::vector<float>& a, const std::vector<float>& b) {
  constexpr int kSide = 16;
  std::vector<double> counts(kSide * kSide), expected(kSide * kSide, static_cast<double>(a.size()) / (kSide * kSide));
  for (size_t i = 0; i < a.size(); ++i) {
    ++counts[static_cast<size_t>(static_cast<int>(a[i] * kSide) * kSide + static_cast<int>(b[i] * kSide))];
  }
  return test::chi_square_p(counts, expected);
}

// Sample i of a van der Corput sequence, scrambled as Owen does, by Laine & Karras's hash with Burley's constants.
double owen_scrambled(uint32_t i, uint32_t seed) {
  uint32_t x = i + seed;
  for (const uint32_t factor : {0x6c50b47cu, 0xb82f1e52u, 0xc7afe638u, 0x8d22f6e6u}) x ^= x * factor;
  uint32_t reversed = 0;
  for (int bit = 0; bit < 32; ++bit) reversed |= (x >> bit & 1) << (31 - bit);
  return reversed * 0x1p-32;
}

// error[n - 1]: the root mean square, over series, of the error of the mean of u over its first n samples.
std::vector<double> errors(const std::vector<std::vector<double>>& series) {
  std::vector<double> result(series[0].size(), 0.0);
  for (const std::vector<double>& samples : series) {
    double sum = 0;
    for (size_t n = 0; n < samples.size(); ++n) {
      sum += samples[n] - 0.5;
      const double error = sum / static_cast<double>(n + 1);
      result[n] += error * error / static_cast<double>(series.size());
    }
  }
  for (double& e : result) e = std::sqrt(e);
  return result;
}

void check_independent(Sampler sampler) {
#ifdef NDEBUG
  constexpr size_t kSamples = 1 << 18;
#else
  constexpr size_t kSamples = 1 << 13;
#endif
  // Not here: samples and seeds exactly 2^31 apart, which the hash does not part well (correlations of 0.03 and 0.25). A set
  // of a Sobol sequence is too uniform for chance, which the test lets pass.
  Decision base{.name = "base"};
  std::vector<Decision> others = {{.name = "camera", .set = random_set(2, kSetLens)},
                                  {.name = "next pixel", .pixel = base.pixel + 1},
                                  {.name = "next row", .pixel = base.pixel + 480},
                                  {.name = "pixel 2^16 on", .pixel = base.pixel + (1 << 16)},
                                  {.name = "sample 2^16 on", .lag = 1 << 16},
                                  {.name = "next seed", .seed = 1},
                                  {.name = "seed 2^16", .seed = 1 << 16},
                                  {.name = "seed 2^32", .seed = uint64_t{1} << 32},
                                  {.name = "seed 2^63", .seed = uint64_t{1} << 63}};
  if (sampler == Sampler::kRandom) {  // in a sequence these are neighbours, which keep apart
    others.push_back({.name = "next sample", .lag = 1});
    others.push_back({.name = "sample 2^10 on", .lag = 1 << 10});
  }
  for (uint32_t light = 0; light < 8; ++light) {
    others.push_back({.name = "light", .set = random_set(2, kSetLight + light)});
  }
  for (const uint32_t bounce : {0u, 1u, 3u, 4u, 7u, 1000u, 65534u}) {
    others.push_back({.name = "bounce", .set = random_set(bounce, kSetPath)});
  }
  base.sampler = sampler;
  for (Decision& other : others) other.sampler = sampler;
  const size_t tests = 2 * (16 * others.size() + 6);
  const double level = test::sidak(0.01, tests);
  const double bound = quantile(complement(boost::math::normal(), level / 2)) / std::sqrt(double(kSamples));
  double worst_correlation = 0, worst_p = 1;
  // Pairs of short sequences fill cells less evenly than chance does; over several sequences that goes away.
  const bool enough = sampler == Sampler::kRandom || kSamples > 1 << kSequenceBits;
  const auto check = [&](const std::vector<float>& a, const std::vector<float>& b) {
    const double r = std::abs(correlation(a, b)), p = uniform_p(a, b);
    CHECK(r < bound);
    if (enough) CHECK(p > level);
    worst_correlation = std::max(worst_correlation, r);
    worst_p = std::min(worst_p, p);
  };
  const Numbers u = draw(base, kSamples);
  for (size_t i = 0; i < 4; ++i) {
    for (size_t j = 0; j < i; ++j) check(u[i], u[j]);
  }
  for (const Decision& other : others) {
    CAPTURE(other.name);
    CAPTURE(other.set);
    const Numbers v = draw(other, kSamples);
    for (size_t i = 0; i < 4; ++i) {
      for (size_t j = 0; j < 4; ++j) check(u[i], v[j]);
    }
  }
  CHECK(correlation(u[0], u[0]) > 0.98);  // the same set for two decisions
  MESSAGE((tests / 2) << " pairs: correlation at most " << worst_correlation << " (bound " << bound << "), p at least "
                      << worst_p << " (bound " << level << "); of a set with itself 1");
}

TEST_SUITE("stability") {
  TEST_CASE("dimensions: two decisions on one set of numbers are biased however many samples") {
    test::Curve curve{.name = "padding",
                      .title = "The integral of u v, u and v of two decisions",
                      .naive = "both decisions draw the same set",
                      .ours = "a set for each decision, core/dimensions.h",
                      .x_axis = "samples",
                      .y_axis = "root mean square error",
                      .points = {}};
    constexpr uint32_t kPixels = 64;
    for (uint32_t n = 16; n <= 1u << 14; n *= 4) {
      double naive = 0, ours = 0;
      for (uint32_t pixel = 0; pixel < kPixels; ++pixel) {
        const Numbers a = draw({.name = "direction", .pixel = pixel}, n);
        const Numbers b = draw({.name = "light", .pixel = pixel, .set = random_set(2, kSetLight)}, n);
        const auto error = [n](const Numbers& u, const Numbers& v) {
          double sum = 0;
          for (size_t i = 0; i < n; ++i) sum += double{u[0][i]} * double{v[0][i]};
          return sum / n - 0.25;
        };
        naive += error(a, a) * error(a, a) / kPixels;
        ours += error(a, b) * error(a, b) / kPixels;
      }
      curve.points.push_back({double(n), std::sqrt(naive), std::sqrt(ours)});
    }
    // The error left is the covariance, 1/12; ours is that of 7/144's root, over the root of n.
    CHECK(curve.points.back().naive == doctest::Approx(1.0 / 12).epsilon(0.02));
    for (const test::CurvePoint& p : curve.points) CHECK(p.ours < 1.5 * std::sqrt(7.0 / 144 / p.x));
    test::record(curve);
  }

  TEST_CASE("dimensions: sets of different purpose, bounce, light, pixel, sample and seed are independent") {
    check_independent(Sampler::kRandom);
  }

  TEST_CASE("dimensions: sequences of different purpose, bounce, light, pixel, sample and seed are independent") {
    check_independent(Sampler::kSobol);
  }

  TEST_CASE("dimensions: every target draws the same numbers, and so does the twin") {
    for (const Sampler sampler : {Sampler::kRandom, Sampler::kSobol}) {
      const Decision base{.name = "base", .lag = 0x1234FFF0, .seed = 0x123456789ABCDEFu, .sampler = sampler};
      Numbers twin;
      for (uint32_t i = 0; i < 4096; ++i) {
        const auto random = reference::draw_random<float>(sampler, base.pixel, base.lag + i, base.set, base.seed);
        for (size_t k = 0; k < 4; ++k) twin[k].push_back(random.u[k]);
      }
      test::for_each_target([&](const char* target) {
        CAPTURE(target);
        CHECK(draw(base, 4096) == twin);
      });
    }
  }

  // Of the first 2^k samples, every elementary interval of volume 2^-k has one in two dimensions where they are the first two
  // (a (0, k, 2)-net), and in each dimension alone; later pairs of the sequence are nets of quality t <= 3.
  TEST_CASE("dimensions: 2^k samples from a multiple of 2^k on are a net") {
    for (const uint32_t first : {0u, 256u, 3u << 16, 0xFFFFFF00u}) {
      const Numbers u = draw({.name = "net", .pixel = first + 7, .lag = first, .sampler = Sampler::kSobol}, 256);
      for (uint32_t k = 0; k <= 8; ++k) {
        for (uint32_t a = 0; a <= k; ++a) {
          std::vector<int> cells(1u << k);
          for (uint32_t i = 0; i < 1u << k; ++i) {
            const auto x = static_cast<uint32_t>(u[0][i] * float(1u << a));
            const auto y = static_cast<uint32_t>(u[1][i] * float(1u << (k - a)));
            ++cells[x << (k - a) | y];
          }
          CHECK(std::all_of(cells.begin(), cells.end(), [](int n) { return n == 1; }));
        }
        for (size_t dimension = 0; dimension < 4; ++dimension) {
          std::vector<int> cells(1u << k);
          for (uint32_t i = 0; i < 1u << k; ++i) ++cells[static_cast<size_t>(u[dimension][i] * float(1u << k))];
          CHECK(std::all_of(cells.begin(), cells.end(), [](int n) { return n == 1; }));
        }
      }
    }
  }

  // The error of the mean of u v over pairs of sets: of n samples it falls as n^-1/2 where sets are independent of each other, as
  // Sobol's are, and as 1 / n or better within one set.
  TEST_CASE("dimensions: within a set the error falls faster than of independent numbers") {
    constexpr uint32_t kPixels = 256;
    const auto error = [&](Sampler sampler, uint32_t n) {
      double sum = 0;
      for (uint32_t pixel = 0; pixel < kPixels; ++pixel) {
        const Numbers u = draw({.name = "mean", .pixel = pixel, .sampler = sampler}, n);
        double mean = 0;
        for (uint32_t i = 0; i < n; ++i)
          mean += double{u[0][i]} * double{u[1][i]} * double{u[2][i]} * double{u[3][i]} / n;
        sum += (mean - 1.0 / 16) * (mean - 1.0 / 16) / kPixels;
      }
      return std::sqrt(sum);
    };
    CHECK(error(Sampler::kRandom, 64) / error(Sampler::kRandom, 1024) == doctest::Approx(4).epsilon(0.15));
    CHECK(error(Sampler::kSobol, 64) / error(Sampler::kSobol, 1024) > 12);
    CHECK(error(Sampler::kSobol, 64) < error(Sampler::kRandom, 64) / 3);
  }

  TEST_CASE("dimensions: one sample more never makes the mean worse") {
    constexpr uint32_t kSeries = 256, kSamples = 4096 + 16;
    std::vector<std::vector<double>> naive(kSeries), ours(kSeries);
    std::mt19937 rng(19);
    for (uint32_t s = 0; s < kSeries; ++s) {
      const uint32_t seed = static_cast<uint32_t>(rng());
      for (uint32_t i = 0; i < kSamples; ++i) naive[s].push_back(owen_scrambled(i, seed));
      const Numbers u = draw({.name = "series", .pixel = s}, kSamples);
      ours[s].assign(u[0].begin(), u[0].end());
    }
    const std::vector<double> naive_error = errors(naive), our_error = errors(ours);
    test::Curve curve{.name = "sample-counts",
                      .title = "Stopping at a sample count that is no power of two",
                      .naive = "Owen-scrambled van der Corput sequence",
                      .ours = "--sampler random",
                      .x_axis = "samples",
                      .y_axis = "error over the least error of fewer samples",
                      .points = {}};
    double naive_least = naive_error[0], our_least = our_error[0];
    for (uint32_t n = 2; n <= 4097; ++n) {
      const double a = naive_error[n - 1] / naive_least, b = our_error[n - 1] / our_least;
      for (uint32_t power = 4; power <= 4096; power *= 2) {
        if (n == power || n == power + 1 || 2 * n == 3 * power) curve.points.push_back({double(n), a, b});
      }
      naive_least = std::min(naive_least, naive_error[n - 1]);
      our_least = std::min(our_least, our_error[n - 1]);
      CHECK(b < 1.25);
      // n^-1/2 at every n; 256 series know the error to 4.4%.
      CHECK(std::abs(our_error[n - 1] * std::sqrt(12.0 * n) - 1) < 0.2);
    }
    CHECK(curve.worst_naive() > 30);
    test::record(curve);
  }
}

}  // namespace
}  // namespace lanewise
#endif
