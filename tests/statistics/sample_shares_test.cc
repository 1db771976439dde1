// Pixels that get their share of the samples are as bright as with the same number for all, in every part of the picture.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/scene.h"
#include "core/schedule.h"
#include "core/verify/test_scene.h"
#include "tests/made_up_draw.h"
#include "tests/statistics/two_estimators.h"

TEST_SUITE_BEGIN("statistics");

namespace lanewise {
namespace {

void check(test::Family& means, const std::string& name, const Scene& scene, Settings settings) {
  const Plan even = make_plan(scene, settings);
  settings.allocation = Allocation::kNoise;
  test::check_blocks(means, name, test::compare(even, make_plan(scene, settings)));
}

}  // namespace

TEST_CASE("allocation: as bright by noise as even, of few samples and many, and by any estimator") {
  test::Family means;
  for (const uint32_t spp : {4u, 16u, test::kSpp}) {
    Settings settings = test::settings_of(4);
    settings.spp = spp;
    check(means, std::to_string(spp) + " samples", test::test_scene(), settings);
  }
  Settings plain = test::settings_of(3);
  plain.light_paths = plain.reuse = plain.connect = false, plain.sampler = Sampler::kRandom;
  check(means, "independent samples", test::test_scene(), plain);
  check(means, "sky", test::test_outdoors(), test::settings_of(4));
  CHECK_MESSAGE(means.holds(), means.least_likely());
}

TEST_CASE("allocation: the mean of few samples of one bright path in sixteen is right") {
  // Were a pixel's first sample to have a say in how many it gets, the bright ones would count for less.
  constexpr uint32_t kWidth = 40, kHeight = 4, kRenders = 20000;
  constexpr double kBright = 16, kChance = 0.0625;
  Settings settings;
  settings.width = kWidth, settings.height = kHeight, settings.spp = 3, settings.allocation = Allocation::kNoise;
  settings.threads = 1;
  double sum = 0, squares = 0;
  for (uint64_t render = 0; render < kRenders; ++render) {
    const auto draw = [&](const std::vector<uint32_t>& pixels, uint64_t first, uint32_t count, PixelSums* sums,
                          uint32_t) {
      for (const uint32_t pixel : pixels) {
        for (uint64_t i = first; i < first + count; ++i) {
          const double u = test::MadeUpDraw::uniform((render * kWidth * kHeight + pixel) * 64 + i);
          const double y = u < kChance ? kBright : 0;
          sums[pixel].add(y, y, y);
        }
      }
      return pixels.size() * count;
    };
    const Exposure got = expose(settings, 1, draw);
    double mean = 0;
    for (const float x : got.image.rgb) mean += x / static_cast<double>(got.image.rgb.size());
    sum += mean, squares += mean * mean;
  }
  const double mean = sum / kRenders, deviation = std::sqrt((squares / kRenders - mean * mean) / kRenders);
  CAPTURE(mean);
  CAPTURE(deviation);
  CHECK(deviation < 0.003 * kBright * kChance);
  CHECK(std::abs(mean - kBright * kChance) < 4 * deviation);
}

}  // namespace lanewise

TEST_SUITE_END();
