#include "kernels/reference/generate.h"

#include <doctest/doctest.h>

#include <numeric>

#include "tests/kernel_harness.h"

namespace lanewise {

TEST_CASE("generate: every path is its pixel's and sample's, and SIMD agrees with its twin, with and without a lens") {
  Settings settings;
  settings.width = 37, settings.height = 23;
  SUBCASE("pinhole") {}
  SUBCASE("lens") { settings.lens_radius = 0.2, settings.focal_distance = 3; }
  const Plan plan = test::test_plan(settings);
  std::vector<uint32_t> pixels(settings.width * settings.height);
  std::iota(pixels.begin(), pixels.end(), 0u);
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    for (const uint32_t n : {1u, 5u, 16u, 17u, 31u, 1000u}) {
      for (const uint64_t first : {0ull, 3ull, 1000ull}) {
        PathBuffer buffer(1024);
        PathState& s = buffer.state();
        s.batch = {.pixels = pixels.data(), .samples = 7, .first_sample = 100, .first_path = first, .paths = n};
        generate(plan, s, {0, n});
        double worst = 0;
        bool right = true;
        for (uint32_t i = 0; i < n; ++i) {
          const Path<float> got = load_path<float>(s, i);
          right &= got.pixel == (first + i) / 7 && got.sample == 100 + (first + i) % 7 && got.slot == i;
          Path<double> want;
          want.pixel = got.pixel, want.sample = got.sample;
          reference::generate(plan, want);
          worst = std::max(
              {worst, std::abs(got.d_x - want.d_x), std::abs(got.d_y - want.d_y), std::abs(got.d_z - want.d_z)});
          right &= got.beta_r == 1 && got.beta_g == 1 && got.beta_b == 1 && got.L_r == 0 && got.pdf == 0;
          worst = std::max(
              {worst, std::abs(got.o_x - want.o_x), std::abs(got.o_y - want.o_y), std::abs(got.o_z - want.o_z)});
        }
        for (uint32_t i = n; i < round_up_to_lanes(n); ++i) right &= s.slot[i] == s.capacity;
        CHECK(right);
        CHECK(worst < 2e-7);
      }
    }
  });
}

TEST_CASE("generate: the corner pixels look into the corners of the field of view") {
  Settings settings;
  settings.width = 400, settings.height = 300;
  const Plan plan = test::test_plan(settings);
  const std::vector<uint32_t> pixels = {0, 399, 299 * 400};
  PathBuffer buffer(16);
  PathState& s = buffer.state();
  s.batch = {.pixels = pixels.data(), .samples = 1, .paths = 3};
  generate(plan, s, {0, 3});
  const double x = std::tan(0.4), z = x * 0.75;  // camera looks along +y, aspect 4:3
  CHECK(s.d_x[0] / s.d_y[0] == doctest::Approx(-x).epsilon(0.006));
  CHECK(s.d_z[0] / s.d_y[0] == doctest::Approx(z).epsilon(0.008));
  CHECK(s.d_x[1] / s.d_y[1] == doctest::Approx(x).epsilon(0.006));
  CHECK(s.d_z[2] / s.d_y[2] == doctest::Approx(-z).epsilon(0.008));
}

}  // namespace lanewise
