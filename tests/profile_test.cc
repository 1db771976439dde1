// What a render counts as it goes.
#include "core/profile.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <thread>

#include "core/render.h"
#include "core/verify/test_scene.h"

namespace lanewise {
namespace {

Settings small() {
  Settings settings;
  settings.width = 32, settings.height = 24, settings.spp = 8, settings.wave = 256, settings.threads = 2;
  settings.light_paths = false;  // their counts are in light_paths_test.cc
  return settings;
}

RenderResult render_test_scene(const Settings& settings, ProfileDetail detail = {}) {
  return render(make_plan(test::test_scene(), settings), {}, detail);
}

// Of one call each.
QueueLengths lengths_of(const std::vector<uint32_t>& lengths) {
  QueueLengths all;
  for (const uint32_t length : lengths) all.add(length);
  return all;
}

TEST_CASE("profile: queue lengths are right at their ends, and to a sixteenth between") {
  const QueueLengths none;
  CHECK(none.min() == 0);
  CHECK(none.max() == 0);
  CHECK(none.quantile(0.5) == 0);
  for (const uint32_t length : {1u, 15u, 16u, 4095u, 4096u, QueueLengths::kMostPaths}) {
    const QueueLengths same = lengths_of({length, length, length});
    for (const double q : {0.0, 0.25, 0.5, 1.0}) CHECK(same.quantile(q) == length);
  }
  std::vector<uint32_t> lengths;
  for (uint32_t i = 1; i <= 999; ++i) lengths.push_back(7 * i);
  const QueueLengths spread = lengths_of(lengths);
  CHECK(spread.min() == 7);
  CHECK(spread.max() == 6993);
  for (const double q : {0.01, 0.25, 0.5, 0.75, 0.99}) {
    CHECK(spread.quantile(q) == doctest::Approx(7 * 999 * q).epsilon(1 / 16.0));
  }
  QueueLengths sum = lengths_of({3, 3, 3});
  sum.add(lengths_of({100, 9000}));
  sum.add(none);
  CHECK(sum.min() == 3);
  CHECK(sum.quantile(0.5) == 3);
  CHECK(sum.max() == 9000);
}

TEST_CASE("profile: bounces add up, and each gets what the one before left") {
  const RenderResult result = render_test_scene(small());
  const Profile& profile = result.profile;
  const auto at = [&](Stage stage, size_t bounce) { return profile.bounces[bounce][static_cast<size_t>(stage)]; };
  REQUIRE(profile.bounces.size() == small().max_depth + 1);
  CHECK(profile.samples == 32 * 24 * 8);
  CHECK(at(Stage::kGenerate, 0).paths == profile.samples);
  CHECK(at(Stage::kAccumulate, 0).paths == profile.samples);
  CHECK(at(Stage::kIntersect, 0).rays == profile.samples);
  uint64_t bounce_rays = 0, came = profile.samples;
  for (size_t b = 0; b < profile.bounces.size(); ++b) {
    CHECK(at(Stage::kIntersect, b).paths == came);
    CHECK(at(Stage::kSort, b).paths == came);
    if (b > 0) bounce_rays += at(Stage::kIntersect, b).rays;
    CHECK(at(Stage::kIntersect, b).rays <= came);
    CHECK(came - at(Stage::kSurface, b).paths == profile.paths_by_length[b]);
    // Those that met emitters wait for the wave's end, which counts as bounce 0.
    if (b > 0) CHECK(at(Stage::kRetire, b).paths <= profile.paths_by_length[b]);
    if (b > 0) CHECK(at(Stage::kEmission, b).paths == 0);
    uint64_t shaded = 0;
    for (const Stage stage : {Stage::kShadeDiffuse, Stage::kShadeMicrofacet, Stage::kShadeMirror, Stage::kShadeGlass}) {
      shaded += at(stage, b).paths;
    }
    CHECK(shaded == at(Stage::kSurface, b).paths);
    came = at(Stage::kSurface, b).paths;
    for (const StageCounter& counter : profile.bounces[b]) {
      CHECK(counter.paths <= counter.lanes);
      CHECK(counter.lengths.min() <= counter.lengths.max());
      CHECK(counter.lengths.max() <= small().wave);
      CHECK(counter.paths <= counter.calls * counter.lengths.max());
      CHECK(counter.paths >= counter.calls * counter.lengths.min());
      CHECK(counter.nanoseconds == 0);  // no clock
    }
  }
  CHECK(came == 0);
  CHECK(profile.total(Stage::kRetire).paths == profile.samples);
  CHECK(bounce_rays == profile.bounce_rays);
  CHECK(profile.total(Stage::kOcclude).rays + profile.total(Stage::kOccludeConnection).rays == profile.shadow_rays);
  CHECK(profile.shadow_rays > 0);
  CHECK(result.logs[0].empty());
}

TEST_CASE("profile: the deepest bounces share a place") {
  Settings settings = small();
  settings.max_depth = 40;
  Scene scene = test::test_scene();
  for (Material& material : scene.materials) material.reflectance = {1, 1, 1};  // roulette ends none
  const Profile profile = render(make_plan(scene, settings)).profile;
  REQUIRE(profile.paths_by_length.size() > 2 * kProfiledBounces);
  REQUIRE(profile.bounces.size() == kProfiledBounces);
  uint64_t deep = 0;  // paths that come to bounce kProfiledBounces - 1, to the next, ...
  for (size_t k = kProfiledBounces - 1; k < profile.paths_by_length.size(); ++k) {
    deep += std::accumulate(profile.paths_by_length.begin() + static_cast<ptrdiff_t>(k), profile.paths_by_length.end(),
                            uint64_t{0});
  }
  CHECK(profile.bounces.back()[static_cast<size_t>(Stage::kIntersect)].paths == deep);
}

TEST_CASE("profile: the clock and the log see the same calls, and change no pixel") {
  constexpr uint32_t kWaves = 3;
  const RenderResult plain = render_test_scene(small());
  const RenderResult logged = render_test_scene(small(), {.clock = true, .logged_waves = kWaves});
  CHECK(plain.image.rgb == logged.image.rgb);
  CHECK(logged.profile.total(Stage::kIntersect).nanoseconds > 0);
  uint64_t clocked = 0;
  for (const auto& bounce : logged.profile.bounces) {
    for (const StageCounter& counter : bounce) clocked += counter.nanoseconds;
  }
  CHECK(clocked <= logged.profile.wave_nanoseconds);
  CHECK(logged.profile.waves == logged.profile.total(Stage::kGenerate).calls);
  CHECK(logged.profile.calm_waves <= logged.profile.waves);
  CHECK(logged.profile.calm_wave_nanoseconds <= logged.profile.wave_nanoseconds);
  const StageCounter intersect = logged.profile.total(Stage::kIntersect);
  CHECK(intersect.calm_paths <= intersect.paths);
  CHECK(intersect.calm_nanoseconds <= intersect.nanoseconds);
  for (const auto& log : logged.logs) {
    uint32_t waves = 0;
    uint64_t since = 0;
    REQUIRE(!log.empty());
    for (const LoggedCall& call : log) {
      if (call.stage != Stage::kCount) {
        CHECK(call.start >= since);
        since = call.start + call.nanoseconds;
      } else {
        CHECK(call.start + call.nanoseconds >= since);
        ++waves;
      }
      CHECK(call.paths > 0);
      CHECK(call.bounce <= small().max_depth);
    }
    CHECK(waves <= kWaves);
    CHECK(log.back().stage == Stage::kCount);
  }
}

TEST_CASE("profile: a wave whose thread waits is not calm") {
  Profiler profiler({.clock = true});
  {
    const auto wave = profiler.wave(16);
    const auto call = profiler.call(Stage::kSurface, 2, 16, 16);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  const StageCounter surface = profiler.profile.total(Stage::kSurface);
  CHECK(profiler.profile.waves == 1);
  CHECK(profiler.profile.calm_waves == 0);
  CHECK(surface.calls == 1);
  CHECK(surface.paths == 16);
  CHECK(surface.nanoseconds >= 2'000'000);
  CHECK(surface.calm_paths == 0);
  CHECK(profiler.profile.bounces.size() == 3);
  CHECK(profiler.log().empty());
}

}  // namespace
}  // namespace lanewise
