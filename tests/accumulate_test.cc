#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/film.h"
#include "core/path_reuse.h"
#include "tests/kernel_harness.h"

namespace lanewise {

TEST_CASE("retire: radiance goes to its slot") {
  const Plan plan = test::test_plan();
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    for (uint32_t n = 0; n <= 2 * kLanes; ++n) {
      PathBuffer buffer(64);
      PathState& s = buffer.state();
      for (uint32_t i = 0; i < n; ++i) s.slot[i] = (i * 7) % 64, s.L_r[i] = 1.0f + float(i), s.L_g[i] = 2, s.L_b[i] = 3;
      retire(plan, s, {0, n});
      bool right = true;
      for (uint32_t i = 0; i < n; ++i) {
        right &= s.result_r[(i * 7) % 64] == 1.0f + float(i) && s.result_g[(i * 7) % 64] == 2 &&
                 s.result_b[(i * 7) % 64] == 3;
      }
      CHECK(right);
    }
  });
}

TEST_CASE("accumulate: the same bits however samples are cut into waves; invalid samples are black and counted") {
  constexpr uint32_t kSamples = 13, kPixels = 9, kTotal = kSamples * kPixels;
  const std::vector<uint32_t> pixels = {4, 2, 8, 0, 1, 3, 5, 6, 7};
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> unit(0.0f, 3.0f);
  std::vector<float> radiance(3 * kTotal);
  for (float& x : radiance) x = unit(rng);
  radiance[3 * 20] = std::numeric_limits<float>::quiet_NaN();
  radiance[3 * 40 + 1] = std::numeric_limits<float>::infinity();
  radiance[3 * 60 + 2] = -1e-6f;

  std::vector<PixelSums> want(kPixels);
  for (uint32_t j = 0; j < kTotal; ++j) {
    const bool invalid = j == 20 || j == 40 || j == 60;
    const float* rgb = &radiance[3 * j];
    invalid ? want[pixels[j / kSamples]].add(0, 0, 0) : want[pixels[j / kSamples]].add(rgb[0], rgb[1], rgb[2]);
  }
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    for (const uint32_t wave : {1u, 7u, 16u, 40u, 117u}) {
      std::vector<PixelSums> film(kPixels);
      uint32_t invalid = 0;
      for (uint32_t first = 0; first < kTotal; first += wave) {
        PathBuffer buffer(128);
        PathState& s = buffer.state();
        s.batch = {
            .pixels = pixels.data(), .samples = kSamples, .first_path = first, .paths = std::min(wave, kTotal - first)};
        for (uint32_t i = 0; i < 128; ++i) {
          const uint32_t j = first + i;
          const bool inside = i < s.batch.paths;  // what lies behind the last path must not count
          s.result_r[i] = inside ? radiance[3 * j] : NAN;
          s.result_g[i] = inside ? radiance[3 * j + 1] : NAN;
          s.result_b[i] = inside ? radiance[3 * j + 2] : NAN;
        }
        invalid += accumulate(s, film.data());
      }
      CHECK(invalid == 3);
      CHECK(film == want);
    }
  });
}

TEST_CASE("accumulate: by squares of pixels, of which nobody's samples count nowhere") {
  constexpr uint32_t kSamples = 5, kTotal = 2 * kPathsTogether * kSamples;
  const uint32_t n = kNoPixel;
  const std::vector<uint32_t> pixels = {0, 1, 4, 5, 2, 3, 6, n}, slots = {1, n, 0, 2, n, 3, n, n};
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    std::vector<PixelSums> film(4), want(4);
    PathBuffer buffer(64);
    PathState& s = buffer.state();
    s.batch = {
        .pixels = pixels.data(), .slots = slots.data(), .group = kPathsTogether, .samples = kSamples, .paths = kTotal};
    uint32_t want_invalid = 0;
    for (uint32_t i = 0; i < kTotal; ++i) {
      const uint32_t slot = slots[i / (kSamples * kPathsTogether) * kPathsTogether + i % kPathsTogether];
      const bool invalid = i % 3 == 0;
      s.result_r[i] = s.result_g[i] = s.result_b[i] = invalid ? NAN : static_cast<float>(i);
      if (slot == n) continue;
      want_invalid += invalid;
      const float value = invalid ? 0 : static_cast<float>(i);
      want[slot].add(value, value, value);
    }
    CHECK(accumulate(s, film.data()) == want_invalid);
    CHECK(film == want);
  });
}

TEST_CASE("pixel sums: the same in any order and grouping, for samples of any size") {
  std::mt19937 rng(4);
  std::vector<float> samples;
  for (int i = 0; i < 3000; ++i) samples.push_back(std::exp2(std::uniform_real_distribution<float>(-140, 40)(rng)));
  const auto add_all = [](const std::vector<float>& values) {
    PixelSums sums;
    for (const float x : values) sums.add(x, 0.5f * x, 0);
    return sums;
  };
  const PixelSums want = add_all(samples);
  for (int round = 0; round < 5; ++round) {
    std::shuffle(samples.begin(), samples.end(), rng);
    CHECK(add_all(samples) == want);
    const size_t cut = rng() % samples.size();
    PixelSums parts = add_all({samples.begin() + static_cast<ptrdiff_t>(cut), samples.end()});
    parts += add_all({samples.begin(), samples.begin() + static_cast<ptrdiff_t>(cut)});
    CHECK(parts == want);
  }
  // What is too large for a sum stays the largest of all.
  PixelSums large = want;
  large.add(1e30, 1e30, 1e30);
  PixelSums first;
  first.add(1e30, 1e30, 1e30);
  first += want;
  CHECK(first == large);
  CHECK(large.r.units() == ~Uint128{0});
}

TEST_CASE("pixel sums: samples of 2^-49 and more are exact, darker ones are 2^-73 off at most") {
  std::mt19937 rng(5);
  for (int i = 0; i < 10000; ++i) {
    const float x = std::exp2(std::uniform_real_distribution<float>(-80, 30)(rng));
    PixelSums sums;
    sums.add(x, x, x);
    const double error = std::abs(sums.r.as<double>() - double{x});
    CHECK(error <= (x >= 0x1p-49f ? 0 : 0x1p-73));
    const double square = double{x} * x, square_error = std::abs(sums.y2.as<double>() - square);
    CHECK(square_error <= (x >= 0x1p-5f ? 0 : 0x1p-57));
  }
  // 2^34 of them: a sum of floats would have stopped at some 2^24.
  PixelSums one;
  one.add(0.1f, 0.1f, 0.1f);
  for (int doubling = 0; doubling < 34; ++doubling) one += PixelSums(one);
  CHECK(one.g.as<double>() == double{0.1f} * 0x1p34);
}

TEST_CASE("pixel sums: each number is rounded to the nearest unit, to the even one of two") {
  constexpr int kPlaces = ExactSum<56>::places;
  for (const uint64_t digits : {uint64_t{1}, uint64_t{3}, (uint64_t{1} << 53) - 1, (uint64_t{1} << 52) + 1,
                                (uint64_t{1} << 52) + 0xabcdef12345u, (uint64_t{3} << 51), (uint64_t{5} << 50)}) {
    for (int exponent = -200; exponent < 70; ++exponent) {
      const double x = std::ldexp(static_cast<double>(digits), exponent - 53);
      ExactSum<kPlaces> sum;
      sum.add(x);
      REQUIRE(sum.units() == static_cast<Uint128>(std::nearbyint(std::ldexp(x, kPlaces))));
    }
  }
  ExactSum<kPlaces> most;
  most.add(0);
  CHECK(most.units() == 0);
  most.add(0x1p72);
  CHECK(most.units() == ~Uint128{0});
}

TEST_CASE("pixel sums: as a double they are rounded to the nearest, to the even one of two") {
  std::mt19937_64 rng(6);
  for (int i = 0; i < 100000; ++i) {
    Uint128 units = ((Uint128{rng()} << 64) | rng()) >> (rng() % 128);
    // Every third ends in a one and zeros: among them are those that lie between two doubles.
    if (i % 3 == 0) {
      const auto zeros = rng() % 75;
      units = (units >> zeros | 1) << zeros;
    }
    REQUIRE(ExactSum<72>(units).as<double>() == std::ldexp(static_cast<double>(units), -72));
  }
  for (const Uint128 units : {Uint128{0}, Uint128{1}, (Uint128{1} << 63) - 1, Uint128{1} << 63, ~Uint128{0} >> 64,
                              ~Uint128{0} >> 63, ~Uint128{0}}) {
    CHECK(ExactSum<56>(units).as<double>() == std::ldexp(static_cast<double>(units), -56));
  }
}

TEST_CASE("accumulate: samples too bright to be cut in vectors are added all the same") {
  constexpr uint32_t kSamples = 100;
  const uint32_t pixel = 0;
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    for (const float bright : {0x1p20f, 0x1.8p20f, 1e10f, 3e38f}) {
      PathBuffer buffer(128);
      PathState& s = buffer.state();
      s.batch = {.pixels = &pixel, .samples = kSamples, .paths = kSamples};
      PixelSums want, got;
      for (uint32_t i = 0; i < kSamples; ++i) {
        s.result_r[i] = s.result_g[i] = s.result_b[i] = i == 77 ? bright : 1e-3f * float(i);
        want.add(s.result_r[i], s.result_g[i], s.result_b[i]);
      }
      CHECK(accumulate(s, &got) == 0);
      CHECK(got == want);
    }
  });
}

TEST_CASE("count_shadow_rays: paths whose light sample is worth a ray") {
  test::for_each_target([](const char* target) {
    CAPTURE(target);
    for (uint32_t n = 0; n <= 2 * kLanes; ++n) {
      PathBuffer buffer(64);
      uint32_t want = 0;
      for (uint32_t i = 0; i < n; ++i) {
        (i % 3 == 0   ? buffer.state().c_r
         : i % 3 == 1 ? buffer.state().c_g
                      : buffer.state().c_b)[i] = i % 5 ? 1e-30f : 0.0f;
        want += i % 5 != 0;
      }
      CHECK(count_shadow_rays(buffer.state(), {0, n}) == want);
    }
  });
}

TEST_CASE("film: the mean, and when a pixel has converged") {
  Film film(2);
  film.sums[0] = {};
  film.sums[0].add(0.5, 2, 3);
  film.sums[0].add(1.5, 2, 3);
  film.samples[0] = 2;
  const Image image = develop(film, 2, {0, 0, 2, 1}, nullptr, 1);
  CHECK(image.rgb[0] == 1);
  CHECK(image.rgb[2] == 3);
  CHECK(image.rgb[3] == 0);

  // 100 samples of luminance 1 +- 1: sigma / sqrt(n) is 0.1005.
  PixelSums noisy;
  for (int i = 0; i < 50; ++i) noisy.add(0, 0, 0), noisy.add(2, 2, 2);
  CHECK(mean_luminance(noisy, 100) == doctest::Approx(1));
  CHECK(luminance_variance(noisy, 100) == doctest::Approx(100.0 / 99));
  CHECK(has_converged(noisy, 100, 0.2));
  CHECK_FALSE(has_converged(noisy, 100, 0.19));
  CHECK(has_converged(PixelSums{}, 4, 0.05));  // black so far: 0 <= 0
}

}  // namespace lanewise
