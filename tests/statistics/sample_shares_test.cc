// Pixels that get their share of the samples are as bright as with the same number for all, in every part of the picture.
#include <doctest/doctest.h>

#include <string>

#include "core/scene.h"
#include "core/verify/test_scene.h"
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

}  // namespace lanewise

TEST_SUITE_END();
