// Russian roulette never lowers the variance by itself. A low constant survival makes fireflies; one that is bounded below
// 1 does so where the albedo is near 1, and there a mean of any affordable number of paths comes out low.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/render.h"
#include "tests/kernel_harness.h"
#include "tests/stability/cavity.h"
#include "tests/stability/curve.h"

namespace lanewise {
namespace {

#ifdef NDEBUG
constexpr uint32_t kWalks = 1 << 14;
#else
constexpr uint32_t kWalks = 1 << 11;
#endif
constexpr uint32_t kDepth = 1000;

struct Moments {
  double mean, deviation, largest;  // deviation of one sample, over the mean
  double error() const { return deviation * mean / std::sqrt(double{kWalks}); }
};

Moments moments_of(const std::vector<double>& samples) {
  double sum = 0, squares = 0;
  for (const double x : samples) sum += x;
  const double mean = sum / static_cast<double>(samples.size());
  for (const double x : samples) squares += (x - mean) * (x - mean);
  return {mean, std::sqrt(squares / static_cast<double>(samples.size())) / mean, *std::ranges::max_element(samples)};
}

// Walks in a furnace whose every wall glows with radiance 1 and has this albedo: a path sees the sum of its throughputs
// before each of the events 0 .. kDepth, so that the expected value is 1 + a + ... + a^kDepth.
double furnace(double albedo) {
  double sum = 0;
  for (uint32_t k = 0; k <= kDepth; ++k) sum += std::pow(albedo, k);
  return sum;
}

// survival(beta): the probability of going on after the scattering that led to this throughput.
template <class Survival>
Moments naive_walks(double albedo, const Survival& survival) {
  std::mt19937 rng(18);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<double> samples(kWalks, 0.0);
  for (double& L : samples) {
    double beta = 1;
    for (uint32_t k = 0; k <= kDepth; ++k) {
      L += beta;
      beta *= albedo;
      const double q = survival(beta);
      if (unit(rng) >= q) break;
      beta /= q;
    }
  }
  return moments_of(samples);
}

// The same walks, ended by the kernel.
Moments our_walks(const Plan& plan, double albedo) {
  PathBuffer buffer(kWalks);
  const PathState& s = buffer.state();
  std::vector<double> samples(kWalks, 0.0);
  for (uint32_t i = 0; i < kWalks; ++i) {
    s.beta_r[i] = s.beta_g[i] = s.beta_b[i] = 1;
    s.pixel[i] = i % 1024, s.sample[i] = i / 1024;
  }
  PathState step = s;
  for (step.step.bounce = 0; step.step.bounce <= kDepth; ++step.step.bounce) {
    bool alive = false;
    for (uint32_t i = 0; i < kWalks; ++i) {
      samples[i] += double{s.beta_r[i]};
      s.beta_r[i] *= static_cast<float>(albedo);
      s.beta_g[i] = s.beta_b[i] = s.beta_r[i];
      alive |= s.beta_r[i] > 0;
    }
    if (!alive) break;
    roulette(plan, step, {0, kWalks});
  }
  return moments_of(samples);
}

TEST_SUITE("stability") {
  TEST_CASE("russian roulette: variance against the probability of survival") {
    constexpr double kAlbedo = 0.8;
    test::Curve curve{.name = "roulette-survival",
                      .title = "Roulette with a constant probability of survival in a furnace of albedo 0.8",
                      .naive = "the same survival at every bounce",
                      .ours = "survival = min(1, throughput), kernels/roulette.cc",
                      .x_axis = "constant probability of survival",
                      .y_axis = "standard deviation of one sample over the mean",
                      .log_x = false,
                      .points = {}};
    const Plan plan = test::test_plan();
    Moments ours{};
    test::for_each_target([&](const char* target) {
      CAPTURE(target);
      ours = our_walks(plan, kAlbedo);
      CHECK(std::abs(ours.mean - furnace(kAlbedo)) < 4.5 * ours.error());
      CHECK(ours.deviation < 1);
      CHECK(ours.largest < 20 * ours.mean);
    });
    double largest = 0;
    for (const double q : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0}) {
      const Moments naive = naive_walks(kAlbedo, [q](double) { return q; });
      curve.points.push_back({q, naive.deviation, ours.deviation});
      largest = std::max(largest, naive.largest / naive.mean);
    }
    CHECK(curve.points[9].naive < 1e-9);  // without roulette the sum is exact
    CHECK(curve.worst_naive() > 5);
    CHECK(largest > (kWalks > 10000 ? 1000 : 100));
    test::record(curve);
    MESSAGE("largest sample over the mean: constant survival " << largest << ", ours " << ours.largest / ours.mean);
  }

  TEST_CASE("russian roulette: albedo near 1") {
    test::Curve curve{.name = "roulette-albedo",
                      .title = "Roulette whose survival is at most 0.95, at 1000 bounces",
                      .naive = "survival = min(0.95, throughput)",
                      .ours = "survival = min(1, throughput), kernels/roulette.cc",
                      .x_axis = "albedo of the furnace",
                      .y_axis = "relative error of the mean of 16384 paths",
                      .log_x = false,
                      .points = {}};
    const Plan plan = test::test_plan();
    for (const double albedo : {0.9, 0.95, 0.97, 0.98, 0.99, 1.0}) {
      CAPTURE(albedo);
      const double want = furnace(albedo);
      const Moments naive = naive_walks(albedo, [](double beta) { return std::min(0.95, beta); });
      double ours = 0;
      test::for_each_target([&](const char* target) {
        CAPTURE(target);
        const Moments walks = our_walks(plan, albedo);
        CHECK(walks.deviation < 1.5);
        CHECK(walks.largest <= std::max(want, kDepth + 1.0));
        CHECK(std::abs(walks.mean - want) < 4.5 * walks.error() + 1e-6 * want);
        ours = std::max(ours, std::abs(walks.mean / want - 1));
      });
      curve.points.push_back({albedo, std::abs(naive.mean / want - 1), ours});
    }
    CHECK(curve.worst_naive() > 0.3);
    CHECK(curve.worst_ours() < 4.5 * 1.5 / std::sqrt(double{kWalks}));
    test::record(curve);
  }

  TEST_CASE("russian roulette: unbiased for every probability, and no throughput is lifted above 1") {
    const Plan plan = test::test_plan();
    PathBuffer buffer(kWalks);
    PathState s = buffer.state();
    s.step.bounce = kRouletteBounce;
    for (const float beta : {0.01f, 0.1f, 0.3f, 0.7f, 0.95f, 0.99f, 1.0f, 2.0f}) {
      CAPTURE(beta);
      test::for_each_target([&](const char* target) {
        CAPTURE(target);
        for (uint32_t i = 0; i < kWalks; ++i) {
          s.beta_r[i] = 0.5f * beta, s.beta_g[i] = beta, s.beta_b[i] = 0;
          s.pixel[i] = i, s.sample[i] = 3;
        }
        roulette(plan, s, {0, kWalks});
        double sum = 0, largest = 0;
        bool kept_colour = true;
        for (uint32_t i = 0; i < kWalks; ++i) {
          sum += double{s.beta_g[i]};
          largest = std::max(largest, double{s.beta_g[i]});
          kept_colour &= s.beta_r[i] == 0.5f * s.beta_g[i] && s.beta_b[i] == 0;
        }
        const double q = std::min(1.0, double{beta});
        CHECK(std::abs(sum / kWalks / double{beta} - 1) <= 4.5 * std::sqrt((1 - q) / q / kWalks) + 1e-6);
        CHECK(largest <= std::max(1.0, double{beta}) * (1 + 1e-6));
        CHECK(kept_colour);
      });
    }
  }

  TEST_CASE("russian roulette: a white furnace at -m 1000 and more ends, with the right mean") {
    Settings settings;
    settings.width = settings.height = 16, settings.threads = 1;
    settings.spp = kWalks / 512;
    for (const double albedo : {0.5, 0.9, 0.99, 0.999, 1.0}) {
      for (const uint32_t depth : {1000u, 65535u}) {
        CAPTURE(albedo);
        CAPTURE(depth);
        settings.max_depth = depth;
        const RenderResult result = render(make_plan(test::cavity(albedo), settings));
        std::vector<double> pixels;
        for (size_t i = 0; i < result.image.rgb.size(); i += 3) pixels.push_back(double{result.image.rgb[i]});
        const Moments m = moments_of(pixels);
        const double want = test::cavity_radiance(albedo, depth);
        const double error = m.deviation * m.mean / std::sqrt(static_cast<double>(pixels.size()));
        CHECK(std::abs(m.mean - want) < 4.5 * error);
        CHECK(error < (kWalks > 10000 ? 0.02 : 0.1) * want);
        CHECK(result.stats.invalid_samples == 0);
        CHECK(result.stats.paths_by_length.size() <= depth + 1);
        // By light alone: a path's expected length is below 1 / kCavityShare.
        CHECK(double(result.stats.bounce_rays) < 1.2 / test::kCavityShare * double(result.stats.samples));
      }
    }
  }
}

}  // namespace
}  // namespace lanewise
