#include "core/flip.h"

#include <doctest/doctest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/types.h"

namespace lanewise {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
constexpr uint32_t kWidth = 96, kHeight = 64;

// A disc on a gradient, and a lamp if there is to be a high range; changed as the name says.
Image picture(const std::string& change, bool lamp) {
  Image image(kWidth, kHeight);
  const int center = change == "moved" ? 50 : 48;
  for (int y = 0; y < int{kHeight}; ++y) {
    for (int x = 0; x < int{kWidth}; ++x) {
      for (int c = 0; c < 3; ++c) {
        const bool disc = (x - center) * (x - center) + (y - 32) * (y - 32) < 400;
        float v = disc ? 0.75f - 0.25f * static_cast<float>(c) : static_cast<float>(x + 2 * y + 16 * c) / 512;
        if (lamp && y < 8 && 32 <= x && x < 64) v = 48;
        const uint32_t mixed = static_cast<uint32_t>(x * 7349 + y * 9151 + c * 3571) * 2654435761u;
        if (change == "noisy") v *= 0.5f + static_cast<float>(mixed >> 16) / 65536;
        if (change == "tinted" && c == 2) v *= 1.25f;
        image.pixel(static_cast<uint32_t>(x), static_cast<uint32_t>(y))[c] = v;
      }
    }
  }
  return image;
}

float at(const std::vector<float>& errors, uint32_t x, uint32_t y) { return errors[size_t{y} * kWidth + x]; }

// Floats hold these to some 3e-5: rounding makes differences of 1e-9 between features that are equal, and FLIP their
// root.
void check_values(const std::vector<float>& errors, double mean, double at_46_12, double at_69_40) {
  CHECK(summarize_flip(errors).mean == doctest::Approx(mean).epsilon(5e-5));
  CHECK(at(errors, 46, 12) == doctest::Approx(at_46_12).epsilon(1e-4));
  CHECK(at(errors, 69, 40) == doctest::Approx(at_69_40).epsilon(1e-4));
}

struct Case {
  const char* change;
  double pixels_per_degree, mean, at_46_12, at_69_40;
};

// The values below: tests/flip_values.py.
TEST_CASE("FLIP: the values of the authors' implementation") {
  for (const Case& c : {Case{"noisy", kFlipPixelsPerDegree, 0.066996971, 0.102841, 0.073694},
                        {"noisy", 20, 0.314020012, 0.227635, 0.167822},
                        {"moved", kFlipPixelsPerDegree, 0.056980903, 0.072059, 0.384743},
                        {"moved", 20, 0.039488237, 0.002692, 0.340404},
                        {"tinted", kFlipPixelsPerDegree, 0.196493413, 0.197160, 0.232132},
                        {"tinted", 20, 0.193853378, 0.201279, 0.219828}}) {
    CAPTURE(c.change);
    CAPTURE(c.pixels_per_degree);
    const std::vector<float> errors = flip_ldr(picture(c.change, false), picture("", false), c.pixels_per_degree);
    check_values(errors, c.mean, c.at_46_12, c.at_69_40);
  }
}

TEST_CASE("HDR-FLIP: the values of the authors' implementation") {
  const Image reference = picture("", true);
  const FlipExposures exposures = flip_exposures(reference);
  CHECK(exposures.start == doctest::Approx(-4.501665).epsilon(1e-6));
  CHECK(exposures.stop == doctest::Approx(2.828234).epsilon(1e-6));
  CHECK(exposures.count == 8);
  for (const Case& c : {Case{"noisy", kFlipPixelsPerDegree, 0.097267780, 0.112252, 0.102819},
                        {"noisy", 20, 0.328548878, 0.236809, 0.176022},
                        {"moved", kFlipPixelsPerDegree, 0.051174558, 0.060730, 0.338231},
                        {"moved", 20, 0.036031146, 0.002530, 0.283400},
                        {"tinted", kFlipPixelsPerDegree, 0.197596577, 0.217825, 0.207744},
                        {"tinted", 20, 0.196917308, 0.220882, 0.196009}}) {
    CAPTURE(c.change);
    CAPTURE(c.pixels_per_degree);
    const std::vector<float> errors = flip_hdr(picture(c.change, true), reference, exposures, c.pixels_per_degree);
    check_values(errors, c.mean, c.at_46_12, c.at_69_40);
  }
}

TEST_CASE("FLIP: equal pictures have no error, opposite ones have the largest") {
  const Image image = picture("noisy", true);
  CHECK(summarize_flip(flip_ldr(image, image)).max == 0);
  CHECK(summarize_flip(flip_hdr(image, image, flip_exposures(image))).max == 0);
  Image green(40, 40), blue(40, 40);
  for (size_t i = 0; i < green.rgb.size(); i += 3) green.rgb[i + 1] = blue.rgb[i + 2] = 1;
  const FlipSummary summary = summarize_flip(flip_ldr(green, blue));
  CHECK(summary.min == doctest::Approx(1).epsilon(1e-5));
  CHECK(summary.max <= 1);
}

TEST_CASE("FLIP: pictures smaller than the filters, and one pixel") {
  for (const uint32_t side : {1u, 3u}) {
    Image black(side, side), grey(side, side);
    std::ranges::fill(grey.rgb, 0.5f);
    const FlipSummary summary = summarize_flip(flip_ldr(grey, black));
    CHECK(summary.min > 0.5);
    CHECK(summary.max - summary.min < 1e-5);
  }
}

TEST_CASE("FLIP: the same errors on any number of threads") {
  const Image a = picture("noisy", true), b = picture("", true);
  const std::vector<float> many = flip_hdr(a, b, flip_exposures(b));
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  CHECK(flip_hdr(a, b, flip_exposures(b)) == many);
}

TEST_CASE("FLIP: what is not a number is wrong, and black to its neighbours") {
  Image a = picture("", true), black = a;
  const Image b = a;
  a.pixel(20, 40)[1] = kNan;
  std::fill_n(black.pixel(20, 40), 3, 0.0f);
  const FlipExposures exposures = flip_exposures(b);
  for (const bool high : {false, true}) {
    const auto flip = [&](const Image& x, const Image& y) { return high ? flip_hdr(x, y, exposures) : flip_ldr(x, y); };
    std::vector<float> errors = flip(a, b), want = flip(black, b);
    CHECK(at(errors, 20, 40) == 1);
    CHECK(at(errors, 21, 40) > 0);
    CHECK(at(flip(a, a), 20, 40) == 1);
    errors[40 * kWidth + 20] = want[40 * kWidth + 20];
    CHECK(errors == want);
  }
}

TEST_CASE("FLIP: radiance without bounds is white, radiance below 0 black") {
  Image a = picture("", true), white = a, b = a, black = a;
  a.pixel(20, 40)[0] = kInfinity;
  white.pixel(20, 40)[0] = 1e30f;
  b.pixel(20, 40)[0] = -5;
  black.pixel(20, 40)[0] = 0;
  const Image reference = picture("", true);
  CHECK(flip_ldr(a, reference) == flip_ldr(white, reference));
  CHECK(flip_ldr(b, reference) == flip_ldr(black, reference));
  const FlipExposures exposures = flip_exposures(reference);
  CHECK(flip_hdr(b, reference, exposures) == flip_hdr(black, reference, exposures));
  const std::vector<float> infinite = flip_hdr(a, reference, exposures);
  CHECK(at(infinite, 20, 40) == doctest::Approx(at(flip_hdr(white, reference, exposures), 20, 40)));
  CHECK(flip_exposures(a).count > 100);  // finite, if many
}

TEST_CASE("FLIP: exposures of pictures that are mostly or wholly black") {
  Image image(10, 10);
  CHECK(flip_exposures(image).start == 0);
  CHECK(flip_exposures(image).count == 1);
  CHECK(summarize_flip(flip_hdr(image, image, flip_exposures(image))).max == 0);
  std::fill_n(image.rgb.begin(), 3, 8.0f);
  std::fill_n(image.rgb.begin() + 3, 6, 0.5f);
  const FlipExposures exposures = flip_exposures(image);
  CHECK(exposures.stop - exposures.start == doctest::Approx(4));
  CHECK(exposures.count == 4);
}

TEST_CASE("FLIP: pooling, worked out by hand") {
  const FlipSummary s = summarize_flip({0.5f, 0.0f, 0.25f, 0.25f});
  CHECK(s.mean == 0.25);
  CHECK(s.min == 0);
  CHECK(s.max == 0.5);
  CHECK(s.weighted_quartile1 == 0.25);
  CHECK(s.weighted_median == 0.25);
  CHECK(s.weighted_quartile3 == 0.5);
}

TEST_CASE("FLIP: sizes must agree") {
  CHECK_THROWS_WITH_AS(flip_ldr(Image(2, 3), Image(3, 2)), "the pictures differ in size: 2x3 and 3x2", Error);
}

}  // namespace
}  // namespace lanewise
