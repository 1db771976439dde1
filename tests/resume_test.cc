// A render that is stopped anywhere, saved, and resumed comes to the bits of one that is not.
#include <doctest/doctest.h>

#include <atomic>
#include <functional>
#include <vector>

#include "core/film_file.h"
#include "core/file.h"
#include "core/plan.h"
#include "core/render.h"
#include "core/verify/test_scene.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

Settings small() {
  Settings settings;
  settings.width = 72, settings.height = 40, settings.threads = 2, settings.wave = 256;
  settings.estimate_error = true;
  return settings;
}

Settings adaptive() {
  Settings settings = small();
  settings.spp = 128, settings.adaptive_batch = 16, settings.adaptive_tolerance = 0.1;
  return settings;
}

Settings to_noise() {
  Settings settings = small();
  settings.spp = 256, settings.noise = 0.1, settings.crop = {10, 10, 30, 20};
  return settings;
}

Settings many_samples() {
  Settings settings = small();
  settings.spp = 200;
  return settings;
}

// Through a file, as between two processes.
SavedRender through_file(const SavedRender& state, const Settings& settings) {
  const test::TemporaryFolder folder;
  const FilmFile film{
      .identity = {}, .width = settings.width, .height = settings.height, .ranges = {}, .scene = {}, .state = state};
  write_file(folder.file("state.exr"), encode_film(film));
  return read_film(folder.file("state.exr"), false).state;
}

// asks: how often the render asks whether to stop before it is told so.
RenderResult render_some(const Plan& plan, int asks, const SavedRender* before, SavedRender& after) {
  std::atomic<int> left{asks};
  return render(plan, {.stop = [&] { return --left < 0; },
                       .resume = before,
                       .save = [&](SavedRender&& state) { after = std::move(state); }});
}

}  // namespace

TEST_CASE("resume: stopped again and again, in every mode, the picture has the same bits in the end") {
  for (Settings settings : {many_samples(), adaptive(), to_noise()}) {
    const RenderResult want = render(make_plan(test::test_scene(), settings));
    for (const int asks : {1, 7, 20, 43}) {
      CAPTURE(asks);
      SavedRender state;
      bool begun = false;
      int runs = 0;
      RenderResult got;
      do {
        settings.threads = 1 + runs % 3;
        settings.wave = runs % 2 == 0 ? 256 : 1024;
        const Plan plan = make_plan(test::test_scene(), settings);
        SavedRender after;
        got = render_some(plan, asks + 13 * runs, begun ? &state : nullptr, after);
        state = through_file(after, settings);
        begun = true;
      } while (got.stats.stopped && ++runs < 300);
      CHECK(runs > 0);
      CHECK_FALSE(got.stats.stopped);
      CHECK(got.image.rgb == want.image.rgb);
      CHECK(got.samples == want.samples);
      CHECK(got.stats.converged == want.stats.converged);
      REQUIRE(got.stats.error.has_value() == want.stats.error.has_value());
      if (want.stats.error) CHECK(got.stats.error->mrse == want.stats.error->mrse);
    }
  }
}

TEST_CASE("resume: what has been saved on the way leads to the same bits, too") {
  for (const Settings& settings : {many_samples(), adaptive(), to_noise()}) {
    const Plan plan = make_plan(test::test_scene(), settings);
    const RenderResult want = render(plan);
    std::vector<SavedRender> saved;
    std::atomic<int> now{0};  // a second passes each time that the clock is looked at
    const RenderResult got = render(plan, {.clock = [&] { return double(now++); },
                                           .save = [&](SavedRender&& state) { saved.push_back(std::move(state)); },
                                           .save_every = 12});
    CHECK(got.image.rgb == want.image.rgb);
    REQUIRE(saved.size() > 2);
    for (const size_t i : {size_t{0}, saved.size() / 2, saved.size() - 1}) {
      SavedRender after;
      CHECK(render_some(plan, 1 << 30, &saved[i], after).image.rgb == want.image.rgb);
    }
  }
}

TEST_CASE("resume: a finished render can be given more samples") {
  Settings settings = small();
  settings.spp = 24;
  SavedRender state, ignored;
  render_some(make_plan(test::test_scene(), settings), 1 << 30, nullptr, state);
  settings.spp = 100;
  const Plan plan = make_plan(test::test_scene(), settings);
  CHECK(render_some(plan, 1 << 30, &state, ignored).image.rgb == render(plan).image.rgb);
}

TEST_CASE("resume: a stopped render's picture is that of the samples it has") {
  SavedRender state;
  const Settings settings = many_samples();
  const RenderResult got = render_some(make_plan(test::test_scene(), settings), 20, nullptr, state);
  CHECK(got.stats.stopped);
  CHECK(got.stats.samples_per_pixel < 200);
  const Film film = [&] {
    Film all(size_t{settings.width} * settings.height);
    state.get_film("picture", settings.width, all);
    return all;
  }();
  CHECK(develop(film, settings.width, settings.window()).rgb == got.image.rgb);
  CHECK(film.samples == got.samples);
}

}  // namespace lanewise
