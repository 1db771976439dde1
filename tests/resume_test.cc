// A render that is stopped anywhere, saved, and resumed comes to the bits of one that is not.
#include <doctest/doctest.h>

#include <algorithm>
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
  Film light(film.sums.size());
  state.get_film("light", settings.width, light);
  CHECK(develop(film, settings.width, settings.window(), &light, 2).rgb == got.image.rgb);
  CHECK(film.samples == got.samples);
}

TEST_CASE("resume: what a file could make up is refused, with its name, before anything is drawn") {
  const Settings settings = many_samples();
  const Plan plan = make_plan(test::test_scene(), settings);
  const Plan noise_plan = make_plan(test::test_scene(), to_noise());
  SavedRender good, good_noise;
  render_some(plan, 40, nullptr, good);
  render_some(noise_plan, 40, nullptr, good_noise);
  const auto refusal = [](const Plan& to_render, SavedRender state, const auto& change) -> std::string {
    change(state);
    state.path = "c.exr";
    try {
      render(to_render, {.stop = [] { return true; }, .resume = &state});
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  const auto words = [](SavedRender& state, const std::string& name) -> std::vector<uint32_t>& {
    return std::ranges::find(state.channels, name, &SavedRender::Channel::name)->words;
  };
  CHECK(refusal(plan, good, [](SavedRender&) {}) == "");
  CHECK(refusal(noise_plan, good_noise, [](SavedRender&) {}) == "");
  const std::string pixels = "c.exr: cannot resume: it has other pixels";
  for (const auto move : {+[](Window& area) { area.y += 1; }, +[](Window& area) { area.x += 60000; },
                          +[](Window& area) { std::swap(area.width, area.height); }}) {
    CHECK(refusal(plan, good, [&](SavedRender& s) { move(s.area); }) == pixels);
    CHECK(refusal(noise_plan, good_noise, [&](SavedRender& s) { move(s.area); }) == pixels);
  }
  const std::string more = "c.exr: cannot resume: it has more samples than are asked for";
  CHECK(refusal(plan, good, [&](SavedRender& s) { words(s, "picture.samples.1")[7] = 1; }) == more);
  CHECK(refusal(noise_plan, good_noise, [](SavedRender& s) { s.numbers["drawn"] = 1000; }) == more);
  CHECK(refusal(noise_plan, good_noise, [](SavedRender& s) { s.numbers["count"] = ~uint64_t{0}; }) == more);
  CHECK(refusal(noise_plan, good_noise, [&](SavedRender& s) {
          words(s, "half1.samples.1")[7] = 1;
        }).starts_with("c.exr: cannot resume: damaged"));
  CHECK(refusal(plan, good, [&](SavedRender& s) {
          std::ranges::fill(words(s, "probes.samples.1"), 1);
        }).starts_with("c.exr: cannot resume: damaged"));
  CHECK(refusal(plan, good, [](SavedRender& s) { s.channels.pop_back(); }).starts_with("c.exr: damaged: no channel"));
  CHECK(refusal(noise_plan, good_noise, [](SavedRender& s) {
          s.numbers.erase("drawn");
        }).starts_with("c.exr: damaged: no number"));
}

}  // namespace lanewise
