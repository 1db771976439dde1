#include "core/rounds.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>

#include "tests/made_up_draw.h"

namespace lanewise {
namespace {

// Time that passes with the samples that are drawn, and with nothing else.
struct MadeUpTime {
  std::atomic<double> now{1e6};  // a clock may begin anywhere
  double per_sample;

  explicit MadeUpTime(double seconds) : per_sample(seconds) {}
  test::MadeUpDraw draw() {
    return {.drew = [this](size_t samples) { now = now + per_sample * static_cast<double>(samples); }};
  }
  Clock clock() {
    return [this] { return now.load(); };
  }
};

Settings picture() {
  Settings settings;
  settings.width = 160, settings.height = 128, settings.spp = 1u << 30, settings.seconds = 10;
  return settings;
}

uint64_t range(const ZeroedVector<uint64_t>& samples) {
  const auto [least, most] = std::minmax_element(samples.begin(), samples.end());
  return *most - *least;
}

}  // namespace

TEST_CASE("rounds: a timed round doubles while time allows, then keeps a tenth, then is a single sample") {
  CHECK(timed_round(1, 1000, 500) == 1);
  CHECK(timed_round(64, 1000, 500) == 64);
  CHECK(timed_round(512, 1000, 1e9) == 488);
  CHECK(timed_round(64, 1000, 50) == 45);
  CHECK(timed_round(64, 1000, 1.5) == 1);
  CHECK(timed_round(64, 1000, 0.01) == 1);
}

TEST_CASE("rounds: --time ends within 2%, and no pixel has two samples more than another, at any speed") {
  const size_t pixels = 160 * 128;
  for (const double samples : {3.0, 17.3, 100.0, 150.0}) {  // of each pixel that there is time for
    for (const bool estimate : {false, true}) {
      MadeUpTime time(10 / samples / static_cast<double>(pixels));
      Settings settings = picture();
      settings.estimate_error = estimate;
      const Exposure got = expose(settings, 1, time.draw(), {.clock = time.clock()});
      CAPTURE(samples);
      CAPTURE(estimate);
      const double taken = time.now - 1e6;
      const double piece = 10 / samples / 5;  // a tile is a fifth of a sample of this small picture
      CHECK(taken > std::min(9.9, 10 - piece));
      CHECK(taken < 10.2);
      CHECK(range(got.samples) <= 1);
      CHECK(got.error.has_value() == (estimate && samples > 2));
    }
  }
}

TEST_CASE("rounds: a speed that changes moves the end little") {
  MadeUpTime time(1e-5);
  test::MadeUpDraw draw = time.draw();
  draw.drew = [&](size_t samples) {
    const double seconds = (time.now > 1e6 + 5 ? 2.5 : 1) * time.per_sample * static_cast<double>(samples);
    time.now = time.now + seconds;
  };
  const Exposure got = expose(picture(), 1, draw, {.clock = time.clock()});
  CHECK(time.now - 1e6 > 9.9);
  CHECK(time.now - 1e6 < 10.3);
  CHECK(*std::min_element(got.samples.begin(), got.samples.end()) > 0);
}

TEST_CASE("rounds: a pixel has a sample however little time there is, and no more than -s") {
  MadeUpTime time(1);
  Settings settings = picture();
  settings.seconds = 1e-9;
  CHECK(expose(settings, 2, time.draw(), {.clock = time.clock()}).samples == ZeroedVector<uint64_t>(160 * 128, 1));
  settings.seconds = 1e9;
  settings.spp = 21;
  CHECK(expose(settings, 1, time.draw(), {.clock = time.clock()}).samples == ZeroedVector<uint64_t>(160 * 128, 21));
}

TEST_CASE("rounds: the picture of a time is that of as many samples") {
  MadeUpTime time(10 / 32.5 / (160 * 128));
  Settings settings = picture();
  const Exposure timed = expose(settings, 1, time.draw(), {.clock = time.clock()});
  settings.seconds = 0;
  settings.spp = timed.samples.back();
  const Exposure fixed = expose(settings, 1, time.draw());
  const size_t last = timed.image.rgb.size() - 1;
  CHECK(timed.image.rgb[last] == fixed.image.rgb[last]);
}

TEST_CASE("rounds: --time, resumed, is for what is left of it") {
  Settings settings = picture();
  MadeUpTime time(10 / 100.0 / (160 * 128));
  SavedRender state;
  const Exposure first = expose(settings, 1, time.draw(),
                                {.clock = time.clock(),
                                 .stop = [&] { return time.now >= 1e6 + 4; },
                                 .save = [&](SavedRender&& saved) { state = std::move(saved); }});
  CHECK(first.stopped);
  CHECK(state.seconds == doctest::Approx(4).epsilon(0.05));
  time.now = 2e6;
  const Exposure rest = expose(settings, 1, time.draw(), {.clock = time.clock(), .resume = &state});
  CHECK_FALSE(rest.stopped);
  CHECK(time.now - 2e6 == doctest::Approx(6).epsilon(0.05));
  CHECK(rest.samples.front() > first.samples.front());
}

TEST_CASE("rounds: progress tells the error and comes to its end") {
  MadeUpTime time(10 / 100.0 / (160 * 128));
  Settings settings = picture();
  settings.estimate_error = true;
  double fraction = 0;
  Progress last;
  const auto see = [&](const Progress& p) {
    CHECK(p.fraction >= fraction);
    fraction = p.fraction;
    last = p;
  };
  expose(settings, 1, time.draw(), {.progress = see, .clock = time.clock()});
  CHECK(last.fraction == doctest::Approx(1).epsilon(0.03));
  CHECK(last.seconds == doctest::Approx(10).epsilon(0.03));
  CHECK(last.mrse > 0);
  settings.seconds = 0, settings.spp = 100;
  fraction = 0;
  expose(settings, 1, time.draw(), {.progress = see, .clock = time.clock()});
  CHECK(last.fraction == 1);
  CHECK(last.mrse > 0);
}

TEST_CASE("rounds: of --time and --noise the first to come ends the picture") {
  Settings settings = picture();
  settings.noise = 1e-4;
  settings.spp = 65536;
  settings.estimate_error = true;
  MadeUpTime time(10 / 300.0 / (160 * 128));
  const auto see = [&](const Progress& p) {
    CHECK(p.fraction >= 0);
    CHECK(p.fraction < 1.03);
  };
  const Exposure got = expose(settings, 1, time.draw(), {.progress = see, .clock = time.clock()});
  CHECK(time.now - 1e6 > 9.8);
  CHECK(time.now - 1e6 < 10.2);
  CHECK(got.converged == 0);
  CHECK(got.error);
  settings.noise = 1;
  time.now = 1e6;
  CHECK(expose(settings, 1, time.draw(), {.clock = time.clock()}).converged == 1);
  CHECK(time.now - 1e6 < 5);
}

}  // namespace lanewise
