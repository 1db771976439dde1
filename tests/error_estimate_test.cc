#include "core/error_estimate.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "core/image_compare.h"
#include "core/likely_values.h"
#include "core/noise_film.h"
#include "core/probes.h"
#include "core/render.h"
#include "core/verify/test_scene.h"
#include "tests/flat_means.h"
#include "tests/made_up_draw.h"

namespace lanewise {
namespace {

// MRSE of the exposure against the draw's expectation.
double measured(const Exposure& exposure, const test::MadeUpDraw& draw) {
  Image truth = exposure.image;
  for (uint32_t y = 0; y < truth.height; ++y) {
    for (uint32_t x = 0; x < truth.width; ++x) {
      for (size_t c = 0; c < 3; ++c) truth.pixel(x, y)[c] = static_cast<float>(draw.expectation(y * truth.width + x));
    }
  }
  return compare_images(exposure.image, truth).mrse;
}

Settings picture(uint32_t spp) {
  Settings settings;
  settings.width = 96, settings.height = 80, settings.spp = spp, settings.estimate_error = true;
  return settings;
}

}  // namespace

TEST_CASE("error estimate: pixels of one square are no neighbours, and hang together") {
  MeanPicture scene = test::flat_means(4, 4, 1, 1e-2f);
  scene.side = 2, scene.column = 1, scene.row = 1;                       // squares from (1, 1) on
  for (const size_t i : {5, 6, 9, 10}) scene.pixels[i].rgb = {9, 9, 9};  // one of them, which chance has made bright
  for (PixelMean& pixel : scene.pixels) pixel.variance = 64;
  CHECK(LikelyValues(scene, 1)(1, 1, scene.pixels[5])[0] == doctest::Approx(1));
  scene.side = 1;
  CHECK(LikelyValues(scene, 1)(1, 1, scene.pixels[5])[0] > 1.2);

  // An interval of a quarter of the terms is twice as wide; the value is the same. All squares are alike in themselves.
  MeanPicture calm = test::flat_means(64, 64, 0.49f, 0);
  const auto square = [](size_t i) {
    const double value = (i % 64 / 2 * 7 + i / 128 * 3) % 11 == 0 ? 1 : 1e-9;
    return std::array<double, 3>{value, value, value};
  };
  const ErrorEstimate alone = estimate_error(calm, square, 2);
  calm.side = 2;
  const ErrorEstimate together = estimate_error(calm, square, 2);
  CHECK(together.mrse == doctest::Approx(alone.mrse));
  const auto variance = [](const ErrorEstimate& e) {
    return std::pow(std::log(e.high / e.mrse) / 1.96, 2) - 0.05 * 0.05;
  };
  CHECK(variance(together) == doctest::Approx(4 * variance(alone)).epsilon(0.01));
}

TEST_CASE("error estimate: the narrowest window has probes, in whole squares of its own") {
  for (const uint32_t side : {1u, 2u}) {
    for (const uint32_t width : {1u, 2u, 3u, 5u, 6u}) {
      Settings settings;
      settings.width = 640, settings.height = 5000;
      settings.crop = Window{37, 11, width, 4900};
      const Probes probes(settings, SampleShares(0), true, side);
      CAPTURE(width);
      CHECK(probes.pixels().size() >= size_t{width} * 4900 / Probes::kMostSpacing * 9 / 10);
      size_t squares = 0;
      for (size_t i = 0; i < probes.pixels().size(); ++i) squares += !probes.continues(i);
      CHECK(squares * side * side >= probes.pixels().size());
    }
  }
}

TEST_CASE("error estimate: exact squares give their relative mean, and a calm picture no error") {
  const MeanPicture scene = test::flat_means(20, 10, 0.49f, 0);
  const auto square = [](size_t) { return std::array<double, 3>{0.01, 0.02, 0.03}; };
  const ErrorEstimate error = estimate_error(scene, square, 3);
  CHECK(error.mrse == doctest::Approx(0.02 / 0.25).epsilon(1e-5).scale(0));
  CHECK(error.low < error.mrse);
  CHECK(error.mrse < error.high);
  CHECK(error.high < 1.2 * error.mrse);
  CHECK(estimate_error(
            scene, [](size_t) { return std::array<double, 3>{}; }, 1)
            .high == 0);
}

TEST_CASE("error estimate: what independent and low-discrepancy samples are off by, within a fifth") {
  for (const bool stratified : {false, true}) {
    for (const uint32_t spp : {16u, 64u, 80u}) {
      CAPTURE(stratified);
      CAPTURE(spp);
      const test::MadeUpDraw draw{.stratified = stratified};
      const Exposure got = expose(picture(spp), 2, draw);
      REQUIRE(got.error);
      const double truth = measured(got, draw);
      CHECK(got.error->mrse == doctest::Approx(truth).epsilon(0.2).scale(0));
      CHECK(got.error->low < truth);
      CHECK(truth < got.error->high);
    }
  }
}

TEST_CASE("error estimate: a firefly's error is known from its pixel alone, whatever the other samples' ratio") {
  const test::MadeUpDraw draw{.stratified = true, .firefly = 40 * 96 + 51};  // no probe
  const Exposure got = expose(picture(64), 1, draw);
  const double truth = measured(got, draw);
  CHECK(truth > 1);
  CHECK(got.error->mrse == doctest::Approx(truth).epsilon(0.1).scale(0));
}

TEST_CASE("error estimate: pixels at the edge of something bright are no fireflies") {
  // Bright up to within column 32; less, with noise, from there on. Sequences do well on both.
  const auto truth = [](uint32_t x) { return x < 32 ? 2 : x == 32 ? 0.6 * 2 + 0.4 * 0.5 : 0.5; };
  const auto draw = [&](const std::vector<uint32_t>& pixels, uint64_t first, uint32_t count, PixelSums* sums,
                        uint32_t) {
    for (const uint32_t pixel : pixels) {
      const uint32_t x = pixel % 96;
      for (uint64_t i = first; i < first + count; ++i) {
        const double shift = test::MadeUpDraw::uniform((uint64_t{pixel} << 32) + (i >> 16) + 1);
        const double u = std::fmod(shift + 0.6180339887498949 * static_cast<double>(i & 0xffff), 1.0);
        const double y = x < 32 || (x == 32 && u < 0.6) ? 2 : 0.5 * (x == 32 ? 1 : 0.5 + u);
        sums[pixel].add(y, y, y);
      }
    }
    return pixels.size() * count;
  };
  const Exposure got = expose(picture(64), 2, draw);
  REQUIRE(got.error);
  Image exact = got.image;
  for (size_t i = 0; i < exact.rgb.size(); ++i)
    exact.rgb[i] = static_cast<float>(truth(static_cast<uint32_t>(i / 3 % 96)));
  CHECK(got.error->mrse == doctest::Approx(compare_images(got.image, exact).mrse).epsilon(0.2).scale(0));
}

TEST_CASE("error estimate: nothing is said of one sample, of -a, or where it is not asked for") {
  const test::MadeUpDraw draw;
  CHECK(!expose(picture(1), 1, draw).error);
  Settings settings = picture(64);
  settings.estimate_error = false;
  CHECK(!expose(settings, 1, draw).error);
  settings.estimate_error = true;
  settings.adaptive_batch = 16;
  CHECK(!expose(settings, 1, draw).error);
}

TEST_CASE("error estimate: the picture has the same bits with it, also of rounds, and the estimate with any threads") {
  const test::MadeUpDraw draw;
  Settings settings = picture(200);
  const Exposure with = expose(settings, 2, draw, {.progress = [](const Progress&) {}});
  const Exposure again = expose(settings, 1, draw);
  settings.estimate_error = false;
  CHECK(with.image.rgb == expose(settings, 1, draw).image.rgb);
  CHECK(with.error->mrse == again.error->mrse);
  CHECK(with.error->low == again.error->low);
}

TEST_CASE("error estimate: --noise knows it from its halves") {
  const test::MadeUpDraw draw;
  Settings settings = picture(4096);
  settings.noise = 0.1;
  const Exposure got = expose(settings, 1, draw);
  REQUIRE(got.error);
  CHECK(got.error->mrse == doctest::Approx(measured(got, draw)).epsilon(0.15).scale(0));
  CHECK(got.error->mrse < 0.01);
}

TEST_CASE("error estimate: of a rendered picture, with either sampler") {
#ifdef NDEBUG
  const uint32_t many = 4096;
#else
  const uint32_t many = 512;
#endif
  Settings settings;
  settings.width = 64, settings.height = 48, settings.max_depth = 3;
  settings.spp = many, settings.seed = 1;
  const Image truth = render(make_plan(test::test_box(), settings)).image;
  settings.seed = 0;
  settings.estimate_error = true;
  // Of few samples little is known where a lamp's edge, or a bright path, may be one of them; and that is known.
  for (const uint32_t spp : {2u, 4u, 16u, 64u}) {
    for (const Sampler sampler : {Sampler::kSobol, Sampler::kRandom}) {
      settings.sampler = sampler, settings.spp = spp;
      const RenderResult got = render(make_plan(test::test_box(), settings));
      const double measured = compare_images(got.image, truth).mrse;
      REQUIRE(got.stats.error);
      CAPTURE(spp);
      CAPTURE(measured);
      CHECK(measured > got.stats.error->low);
      CHECK(measured < got.stats.error->high);
      if (spp < 64) continue;
      CHECK(got.stats.error->mrse / measured > 0.6);
      CHECK(got.stats.error->mrse / measured < 2.5);
      CHECK(got.stats.error->high / got.stats.error->mrse < 6);
    }
  }
}

TEST_CASE("probes: one pixel in 32, fewer apart in small pictures, all within the window") {
  Settings settings = picture(16);
  settings.width = 640, settings.height = 480;
  CHECK(Probes(settings, SampleShares(0), true).pixels().size() == 640 * 480 / 32);
  settings.crop = {100, 50, 33, 21};
  const Probes probes(settings, SampleShares(0), true);
  CHECK(probes.pixels().size() >= Probes::kWanted);
  for (size_t i = 0; i < probes.pixels().size(); ++i) {
    const uint32_t x = probes.pixels()[i] % 640, y = probes.pixels()[i] / 640;
    const bool inside = x >= 100 && x < 133 && y >= 50 && y < 71;
    CHECK(inside);
    CHECK(probes.place(i) == size_t{y - 50} * 33 + x - 100);
  }
  settings.crop = {5, 5, 1, 1};
  CHECK(Probes(settings, SampleShares(0), true).pixels().size() == 1);
  CHECK(Probes(settings, SampleShares(0), false).pixels().empty());
}

}  // namespace lanewise
