// Many samples: sums that neither drift nor end, sample numbers beyond 32 bits, and no memory that grows with them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/render.h"
#include "core/schedule.h"
#include "scenes/load.h"
#include "tests/made_up_draw.h"
#include "tests/program.h"
#include "tests/scene_paths.h"
#include "tests/subprocess.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

Settings small_picture(uint64_t samples) {
  Settings settings;
  settings.width = 8, settings.height = 6, settings.spp = samples;
  return settings;
}

double rms_error(const Exposure& got) {
  double squares = 0;
  for (uint32_t i = 0; i < 48; ++i) {
    const double e = got.image.rgb[3 * i] / test::MadeUpDraw::expectation(i) - 1;
    squares += e * e;
  }
  return std::sqrt(squares / 48);
}

}  // namespace

TEST_CASE("long runs: the mean of a million samples is theirs, to a float's last bit, and its error still falls") {
#ifdef NDEBUG
  constexpr uint64_t kMany = 1'000'000;
#else
  constexpr uint64_t kMany = 100'000;  // under sanitizers
#endif
  const test::MadeUpDraw draw;
  const Exposure got = expose(small_picture(kMany), 2, draw);
  for (const uint32_t pixel : {0u, 17u, 47u}) {
    // In twice the digits of a double.
    __float128 sum = 0;
    for (uint64_t sample = 0; sample < kMany; ++sample) {
      PixelSums one[48];
      draw({pixel}, sample, 1, one, 0);
      sum += one[pixel].r.as<double>();
    }
    const auto mean = static_cast<double>(sum / kMany);
    CHECK(std::abs(got.image.rgb[3 * pixel] / mean - 1) <= 0x1p-24);
  }
  // The noise of means of n samples is 1 / sqrt(n) of them; of 48 pixels the measure of it is within a third of it.
  for (const uint64_t samples : {uint64_t{1'000}, uint64_t{30'000}, kMany}) {
    CAPTURE(samples);
    const Exposure mean = samples == kMany ? got : expose(small_picture(samples), 2, draw);
    const double noise = rms_error(mean) * std::sqrt(static_cast<double>(samples));
    CHECK(noise > 0.67);
    CHECK(noise < 1.33);
  }
}

TEST_CASE("long runs: samples whose numbers go beyond 32 bits are others, and cut anywhere make the same picture") {
  const Plan before = make_plan(load_scene(test::shipped_scene("cornell_spheres.dae").string()), small_picture(1));
  const auto range = [&](uint64_t first, uint64_t count) {
    Plan plan = before;
    plan.settings.first_sample = first;
    plan.settings.spp = count;
    Film film(48);
    const RenderControl control{.save = [&](SavedRender&& state) { state.get_film("picture", 8, film); }};
    render(plan, control);
    return film;
  };
  for (const uint64_t edge : {uint64_t{1} << 32, uint64_t{1} << 33, uint64_t{1} << 40}) {
    CAPTURE(edge);
    const Film whole = range(edge - 40, 100), low = range(edge - 40, 40), high = range(edge, 60), first = range(0, 60);
    int same_as_first = 0;
    for (size_t i = 0; i < 48; ++i) {
      PixelSums sum = low.sums[i];
      sum += high.sums[i];
      CHECK(whole.samples[i] == 100);
      CHECK(sum.y.units() == whole.sums[i].y.units());
      CHECK(sum.y2.units() == whole.sums[i].y2.units());
      same_as_first += high.sums[i].y == first.sums[i].y;
    }
    CHECK(same_as_first < 24);  // black pixels are
  }
}

TEST_CASE("long runs: a hundred times the samples take no more memory") {
  if (test::nothing_to_test()) return;
  const test::TemporaryFolder folder;
  const auto peak = [&](const std::string& samples) {
    const test::ProcessResult r =
        test::run_process(test::program(),
                          {"render", test::box(), "-r", "8", "6", "-p", "3", "3", "2", "1", "-q", "-f", "a.pfm",
                           "--checkpoint", "c-" + samples + ".exr", "--every", "50ms", "-s", samples},
                          folder.path());
    REQUIRE(r.exit_code == 0);
    return static_cast<double>(r.peak_kilobytes);
  };
#ifdef NDEBUG
  const double few = peak("4000"), many = peak("400000");
#else
  const double few = peak("400"), many = peak("40000");
#endif
  CHECK(few > 1000);
  CHECK(many < 1.15 * few);
}

}  // namespace lanewise
