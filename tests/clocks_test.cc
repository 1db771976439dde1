// Clocks that jump, as when a machine is suspended or moved, and clocks that stand still.
#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "core/render_control.h"
#include "core/schedule.h"
#include "tests/made_up_draw.h"

namespace lanewise {
namespace {

constexpr double kHour = 3600;
constexpr double kPerSample = 1e-6;  // seconds

// Time that passes with the samples that are drawn; at `when` samples the clock jumps, and it stands still until `still`.
struct FaultyClock {
  double jump = 0;
  uint64_t when = 300'000;
  uint64_t still = 0;
  std::atomic<uint64_t> drawn{0};

  double now() const {
    const uint64_t n = drawn;
    return 1e5 + kPerSample * static_cast<double>(n - std::min(n, still)) + (n >= when ? jump : 0);
  }
  test::MadeUpDraw draw() {
    return {.drew = [this](size_t samples) { drawn += samples; }};
  }
};

enum class Mode { kSamples, kTime, kNoise, kNoiseAndTime, kAdaptive };
constexpr Mode kModes[] = {Mode::kSamples, Mode::kTime, Mode::kNoise, Mode::kNoiseAndTime, Mode::kAdaptive};

Settings settings_of(Mode mode) {
  Settings settings;
  settings.width = 48, settings.height = 32, settings.spp = 1000;
  settings.estimate_error = true;
  if (mode == Mode::kTime || mode == Mode::kNoiseAndTime) settings.seconds = 1, settings.spp = 20'000;
  if (mode == Mode::kNoise || mode == Mode::kNoiseAndTime) settings.noise = mode == Mode::kNoise ? 0.02 : 0.0001;
  if (mode == Mode::kAdaptive) settings.adaptive_batch = 16, settings.adaptive_tolerance = 0.02;
  return settings;
}

// What a render has told and saved on its way.
struct Witness {
  std::vector<Progress> progress;
  std::vector<uint64_t> saved_at;  // samples drawn
  std::vector<double> seconds;     // saved
};

Exposure watched(Mode mode, FaultyClock& clock, Witness& witness, uint32_t threads = 2) {
  const RenderControl control{.progress = [&](const Progress& p) { witness.progress.push_back(p); },
                              .clock = [&] { return clock.now(); },
                              .save =
                                  [&](SavedRender&& saved) {
                                    witness.saved_at.push_back(clock.drawn);
                                    witness.seconds.push_back(saved.seconds);
                                  },
                              .save_every = 0.1};
  return expose(settings_of(mode), threads, clock.draw(), control);
}

}  // namespace

TEST_CASE("clocks: one that jumps changes neither the bits nor what is told to something impossible") {
  for (const Mode mode : kModes) {
    CAPTURE(static_cast<int>(mode));
    FaultyClock good;
    Witness unused;
    const Exposure want = watched(mode, good, unused);
    for (const double jump : {kHour, -kHour, -1e9, 0.0}) {
      CAPTURE(jump);
      FaultyClock clock{.jump = jump};
      if (jump == 0.0) clock.still = 600'000;
      Witness witness;
      const Exposure got = watched(mode, clock, witness);
      CHECK_FALSE(got.image.rgb.empty());
      double before = 0;
      for (const Progress& p : witness.progress) {
        CHECK(p.fraction >= 0);
        CHECK(p.fraction <= 1);
        CHECK(std::isfinite(p.seconds));
        CHECK(p.seconds >= before);
        before = p.seconds;
      }
      // Each save lies at the end of a tenth of a second of 100,000 samples, or a tile of each thread later, whatever the clock says of them;
      // the last is at the end.
      REQUIRE_FALSE(witness.saved_at.empty());
      uint64_t last = std::max<uint64_t>(clock.still, 0);
      for (const uint64_t at : witness.saved_at) {
        if (at > last) CHECK(at - last < 600'000);
        last = std::max(last, at);
      }
      CHECK(std::ranges::is_sorted(witness.seconds));
      CHECK(witness.seconds.front() >= 0);
      if (settings_of(mode).seconds == 0) CHECK(got.image.rgb == want.image.rgb);
    }
  }
}

TEST_CASE("clocks: --time ends by what has passed, whatever the clock falls back by, and at once where it is over") {
  for (const Mode mode : {Mode::kTime, Mode::kNoiseAndTime}) {
    CAPTURE(static_cast<int>(mode));
    const auto drawn = [&](FaultyClock& clock) {
      Witness witness;
      watched(mode, clock, witness);
      return clock.drawn.load();
    };
    FaultyClock good, back{.jump = -kHour}, ahead{.jump = kHour}, still{.still = 200'000};
    const uint64_t second = drawn(good);
    CHECK(second > 800'000);
    CHECK(second < 1'200'000);
    CHECK(std::abs(static_cast<double>(drawn(back)) - 1e6) < 2e5);
    CHECK(drawn(ahead) < 500'000);
    CHECK(std::abs(static_cast<double>(drawn(still)) - 1.2e6) < 3e5);
  }
}

TEST_CASE("clocks: one that never moves ends no render early, and holds none up") {
  for (const Mode mode : kModes) {
    if (settings_of(mode).seconds > 0) continue;
    CAPTURE(static_cast<int>(mode));
    FaultyClock good, never{.still = ~uint64_t{0}};
    Witness unused, witness;
    const Exposure want = watched(mode, good, unused), got = watched(mode, never, witness);
    CHECK(got.image.rgb == want.image.rgb);
    CHECK(witness.saved_at.size() == 1);
    for (const Progress& p : witness.progress) CHECK(std::isfinite(p.fraction));
  }
}

TEST_CASE("clocks: a render that is to be saved all the time still gets on") {
  for (const Mode mode : kModes) {
    CAPTURE(static_cast<int>(mode));
    if (settings_of(mode).seconds > 0) continue;
    FaultyClock clock;
    Witness unused;
    const Exposure want = watched(mode, clock, unused);
    // Time passes whenever it is asked for: as if every thread took longer to begin than the time between two saves.
    std::atomic<int> asked{0};
    int saves = 0;
    Settings settings = settings_of(mode);
    const Exposure got = expose(settings, 2, test::MadeUpDraw{},
                                {.clock = [&] { return static_cast<double>(++asked); },
                                 .save = [&](SavedRender&&) { ++saves; },
                                 .save_every = 0.5});
    CHECK(saves > 1);
    CHECK(got.image.rgb == want.image.rgb);
  }
}

}  // namespace lanewise
