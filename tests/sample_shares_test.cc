// --allocation noise: shares of samples, the pictures that are made with them, cut in any way, and that they pay.
#include "core/sample_shares.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>
#include <set>

#include "core/image_compare.h"
#include "core/render.h"
#include "core/rounds.h"
#include "core/saved_render.h"
#include "core/schedule.h"
#include "core/verify/test_scene.h"
#include "tests/made_up_draw.h"

namespace lanewise {
namespace {

constexpr uint32_t kWidth = 50, kHeight = 39;  // blocks at the edges are cut

Settings by_noise(uint64_t spp) {
  Settings settings;
  settings.width = kWidth, settings.height = kHeight, settings.spp = spp, settings.threads = 2, settings.wave = 256;
  settings.allocation = Allocation::kNoise;
  return settings;
}

// First samples of a picture whose noise is four times as strong in its right half, and none in its first rows.
std::vector<PixelSums> first_samples() {
  std::vector<PixelSums> sums(kWidth * kHeight);
  for (uint32_t i = 0; i < sums.size(); ++i) {
    const uint32_t x = i % kWidth, y = i / kWidth;
    const double u = test::MadeUpDraw::uniform(i), noise = y < 12 ? 0 : x < kWidth / 2 ? 0.2 : 0.8;
    sums[i].add(1 + noise * (2 * u - 1), 1 + noise * (2 * u - 1), 1 + noise * (2 * u - 1));
  }
  return sums;
}

// Noise of another strength in each quarter of the picture, about a mean of 1.
struct Quarters {
  uint64_t operator()(const std::vector<uint32_t>& pixels, uint64_t first, uint32_t count, PixelSums* sums,
                      uint32_t) const {
    for (const uint32_t pixel : pixels) {
      const bool right = pixel % kWidth >= kWidth / 2, low = pixel / kWidth >= kHeight / 2;
      const double noise = (right ? 1 : 0.25) * (low ? 1 : 0.25);
      for (uint64_t i = first; i < first + count; ++i) {
        const double u = test::MadeUpDraw::uniform((uint64_t{pixel} << 32) + 0x9E3779B97F4A7C15u * (i + seed));
        const double y = 1 + noise * (test::MadeUpDraw::value(u) - 1);
        sums[pixel].add(y, y, y);
      }
    }
    return pixels.size() * count;
  }
  uint64_t seed = 1;
};

double error_of(const Exposure& exposure) {
  Image truth = exposure.image;
  std::ranges::fill(truth.rgb, 1.0f);
  return compare_images(exposure.image, truth).mrse;
}

double mean(const ZeroedVector<uint64_t>& samples) {
  return std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(samples.size());
}

RenderResult render_with(const Settings& settings, const RenderControl& control = {}) {
  return render(make_plan(test::test_scene(), settings), control);
}

}  // namespace

TEST_CASE("sample shares: in proportion to the noise, as many in all as there would be") {
  const std::vector<PixelSums> sums = first_samples();
  const SampleShares shares(0, kWidth, kHeight, {0, 0, kWidth, kHeight}, sums.data(), 2);
  REQUIRE(!shares.even());
  double left = 0, right = 0, all = 0;
  for (uint32_t i = 0; i < kWidth * kHeight; ++i) {
    const uint32_t x = i % kWidth, y = i / kWidth;
    all += shares.share(i);
    const uint32_t square = (y - y % 2) * kWidth + x - x % 2, corner = (y - y % 4) * kWidth + x - x % 4;
    CHECK(shares.share(i) == shares.share(square));
    if ((x / 2 + y / 2) % 2 == 0) CHECK(shares.share(i) == shares.share(corner));
    if (y < 8) CHECK(shares.share(i) == SampleShares::kLeast);
    if (y >= 20 && x < 16) left += shares.share(i) / (16.0 * 19);
    if (y >= 20 && x >= 32 && x < 48) right += shares.share(i) / (16.0 * 19);
  }
  all /= 8 * kWidth * kHeight;
  CHECK(all <= 1);
  CHECK(all > 0.98);
  CHECK(right / left == doctest::Approx(4).epsilon(0.15));
}

TEST_CASE("sample shares: a pixel's sample has no say in its own share, nor in those of its colour") {
  std::vector<PixelSums> sums = first_samples();
  const SampleShares before(0, kWidth, kHeight, {0, 0, kWidth, kHeight}, sums.data(), 2);
  const uint32_t changed[] = {0, 17 * kWidth + 20, 38 * kWidth + 49};
  for (const uint32_t pixel : changed) {
    sums = first_samples();
    sums[pixel].add(1000, 0, 5);
    const SampleShares after(0, kWidth, kHeight, {0, 0, kWidth, kHeight}, sums.data(), 2);
    const auto colour = [](uint32_t i) { return SampleShares::colour(i % kWidth, i / kWidth); };
    size_t others = 0;
    for (uint32_t i = 0; i < kWidth * kHeight; ++i) {
      if (colour(i) == colour(pixel)) {
        REQUIRE(after.share(i) == before.share(i));
      } else {
        others += after.share(i) != before.share(i);
      }
    }
    CHECK(others > 0);
  }
}

TEST_CASE("sample shares: as many in all where few pixels have met noise, too") {
  for (const uint32_t noisy : {1u, 3u, 20u}) {
    CAPTURE(noisy);
    std::vector<PixelSums> sums(200 * 160);
    for (uint32_t i = 0; i < noisy; ++i) sums[1234 + 1601 * i].add(9, 9, 9);
    const SampleShares shares(0, 200, 160, {0, 0, 200, 160}, sums.data(), 2);
    double all = 0;
    for (uint32_t i = 0; i < sums.size(); ++i) all += shares.mean_count(i);
    CHECK(shares.share(1234 + 2) == SampleShares::kMost);
    CHECK(all <= 200 * 160);
    CHECK(all > 0.6 * 200 * 160);
  }
}

TEST_CASE("sample shares: a black picture and a calm one get the same for every pixel") {
  std::vector<PixelSums> sums(kWidth * kHeight);
  CHECK(SampleShares(0, kWidth, kHeight, {0, 0, kWidth, kHeight}, sums.data(), 2).even());
  for (PixelSums& s : sums) s.add(0.5, 0.25, 2);
  CHECK(SampleShares(0, kWidth, kHeight, {0, 0, kWidth, kHeight}, sums.data(), 2).even());
  const SampleShares same(7);
  CHECK(same.even());
  CHECK(same.first(5) == 7);
  CHECK(same.count(5, 100) == 100);
  CHECK(same.samples_for(5, 100) == 100);
}

TEST_CASE("sample shares: ranges of samples follow on each other, and nothing overflows") {
  const std::vector<PixelSums> sums = first_samples();
  const SampleShares whole(0, kWidth, kHeight, {0, 0, kWidth, kHeight}, sums.data(), 2);
  for (uint32_t pixel = 0; pixel < kWidth * kHeight; pixel += 7) {
    uint64_t before = 0;
    for (const uint64_t cut : {0u, 1u, 5u, 16u, 37u, 1000u}) {
      const SampleShares rest(cut, kWidth, kHeight, {0, 0, kWidth, kHeight}, sums.data(), 2);
      REQUIRE(rest.first(pixel) == whole.count(pixel, cut));
      REQUIRE(whole.count(pixel, cut) + rest.count(pixel, 123) == whole.count(pixel, cut + 123));
      REQUIRE(whole.count(pixel, cut) >= before);
      before = whole.count(pixel, cut);
      const uint64_t n = rest.count(pixel, 123), most = rest.samples_for(pixel, n);
      REQUIRE(most >= 123);
      REQUIRE(rest.count(pixel, most) == n);
      REQUIRE(rest.count(pixel, most + 1) > n);
    }
    REQUIRE(whole.count(pixel, 1) >= 1);
    REQUIRE(whole.count(pixel, kMaxSpp) == kMaxSpp / 8 * whole.share(pixel));
  }
}

TEST_CASE("allocation: samples go where the noise is, the error is less, and its estimate right") {
  const Exposure even = [] {
    Settings settings = by_noise(64);
    settings.allocation = Allocation::kEven;
    return expose(settings, 2, Quarters{});
  }();
  Settings settings = by_noise(64);
  settings.estimate_error = true;
  const Exposure uneven = expose(settings, 2, Quarters{});
  CHECK(mean(uneven.samples) == doctest::Approx(64).epsilon(0.02));
  CHECK(error_of(uneven) < 0.75 * error_of(even));
  REQUIRE(uneven.error);
  CHECK(uneven.error->mrse == doctest::Approx(error_of(uneven)).epsilon(0.2).scale(0));
  CHECK(uneven.samples[0] < 64);
  CHECK(uneven.samples.back() > 64);
}

TEST_CASE("allocation: the same bits for any wave, threads, part of the picture, and rounds") {
  const RenderResult whole = render_with(by_noise(12));
  const std::set<uint64_t> counts(whole.samples.begin(), whole.samples.end());
  CHECK(counts.size() > 3);
  for (const uint32_t wave : {16u, 48u, 4096u}) {
    Settings settings = by_noise(12);
    settings.wave = wave, settings.threads = 3;
    settings.estimate_error = true;  // in rounds
    CHECK(render_with(settings, {.progress = [](const Progress&) {}}).image.rgb == whole.image.rgb);
  }
  for (const Window crop : {Window{0, 0, 16, 16}, {5, 3, 9, 17}, {32, 24, 1, 1}, {49, 38, 1, 1}}) {
    Settings settings = by_noise(12);
    settings.crop = crop;
    const RenderResult part = render_with(settings);
    for (uint32_t y = 0; y < crop.height; ++y) {
      for (uint32_t x = 0; x < crop.width; ++x) {
        const size_t i = (crop.y + y) * kWidth + crop.x + x;
        REQUIRE(part.samples[y * crop.width + x] == whole.samples[i]);
        for (size_t c = 0; c < 3; ++c) REQUIRE(part.image.pixel(x, y)[c] == whole.image.rgb[3 * i + c]);
      }
    }
  }
}

TEST_CASE("allocation: stopped at any moment and resumed, it comes to the same bits and the same estimate") {
  Settings settings = by_noise(12);
  settings.estimate_error = true;
  const RenderResult whole = render_with(settings);
  for (const int moment : {0, 1, 2, 4, 7, 11, 16}) {
    CAPTURE(moment);
    std::optional<SavedRender> saved;
    std::atomic<int> asked{0};
    RenderControl control{.stop = [&] { return asked++ >= 5 * moment; },
                          .save = [&](SavedRender&& state) { saved = std::move(state); }};
    render_with(settings, control);
    REQUIRE(saved);
    saved->path = "saved.exr";
    RenderResult rest = render_with(settings, {.resume = &*saved});
    CHECK(rest.image.rgb == whole.image.rgb);
    CHECK(rest.samples == whole.samples);
    REQUIRE(rest.stats.error);
    CHECK(rest.stats.error->mrse == whole.stats.error->mrse);
  }
}

TEST_CASE("allocation: no sample is drawn twice, by the picture or its probes, and none in vain") {
  std::set<std::pair<uint32_t, uint64_t>> drawn;
  const Quarters quarters;
  const auto once = [&](const std::vector<uint32_t>& pixels, uint64_t first, uint32_t count, PixelSums* sums,
                        uint32_t worker) {
    for (const uint32_t pixel : pixels) {
      for (uint32_t i = 0; i < count; ++i) REQUIRE(drawn.insert({pixel, first + i}).second);
    }
    return quarters(pixels, first, count, sums, worker);
  };
  Settings settings = by_noise(100);
  settings.estimate_error = true;
  const Exposure whole = expose(settings, 1, once);
  CHECK(whole.error);
  uint64_t of_picture = 0;
  for (const auto& [pixel, number] : drawn) of_picture += number < whole.samples[pixel];
  CHECK(of_picture == std::accumulate(whole.samples.begin(), whole.samples.end(), uint64_t{0}));
  CHECK(of_picture < drawn.size());
  CHECK(of_picture > 0.79 * static_cast<double>(drawn.size()));  // a pixel in four is a probe, of so small a picture
}

TEST_CASE("allocation: a finished render that is resumed says again which samples it has") {
  for (const Window crop : {Window{0, 0, 0, 0}, {0, 0, 8, 8}}) {  // all; the calmest, of one share
    Settings settings = by_noise(13);
    settings.first_sample = 19, settings.crop = crop;
    const Quarters quarters;
    std::optional<SavedRender> saved;
    for (int turn = 0; turn < 2; ++turn) {
      const std::optional<SavedRender> before = saved;
      expose(settings, 1, quarters,
             {.resume = before ? &*before : nullptr, .save = [&](SavedRender&& state) { saved = std::move(state); }});
      REQUIRE(saved);
      CHECK(saved->number(kWholeSamples) == 13);
    }
  }
  // Where it stops before, no pixel has more than its share of whole samples, or there are none.
  Settings settings = by_noise(64);
  for (const int moment : {3, 10, 20, 40}) {
    std::optional<SavedRender> saved;
    std::atomic<int> asked{0};
    expose(settings, 1, Quarters{},
           {.stop = [&] { return asked++ >= moment; }, .save = [&](SavedRender&& state) { saved = std::move(state); }});
    REQUIRE(saved);
    if (!saved->numbers.contains(kWholeSamples)) continue;
    const SampleShares shares = SampleShares::saved(0, kWidth, kHeight, *saved).value();
    saved->get<uint64_t>("picture.samples", kWidth, [&](size_t i, uint64_t n) {
      REQUIRE(n == shares.count(static_cast<uint32_t>(i), saved->number(kWholeSamples)));
    });
  }
}

TEST_CASE("allocation: a checkpoint whose pixels have not their shares is refused") {
  const Settings settings = by_noise(64);
  std::optional<SavedRender> saved;
  expose(settings, 1, Quarters{}, {.save = [&](SavedRender&& state) { saved = std::move(state); }});
  REQUIRE(saved);
  saved->path = "c.exr";
  const auto refused = [&](SavedRender state, const std::string& channel, uint32_t word, const char* why) {
    for (SavedRender::Channel& c : state.channels) {
      if (c.name == channel) c.words.back() = word;
    }
    CHECK_THROWS_WITH_AS(expose(settings, 1, Quarters{}, {.resume = &state}), why, UsageError);
  };
  refused(*saved, "picture.samples.0", 7, "c.exr: cannot resume: damaged: its pixels have not their shares of samples");
  refused(*saved, "shares.0", 7, "c.exr: cannot resume: damaged: its shares of samples cannot be");
  std::erase_if(saved->channels, [](const SavedRender::Channel& c) { return c.name == "shares.0"; });
  refused(*saved, "", 0, "c.exr: cannot resume: damaged: its shares of samples cannot be");
}

TEST_CASE("allocation: with --time it is resumed with the shares that it had, whatever the time") {
  Settings settings = by_noise(kMaxSpp);
  settings.seconds = 10, settings.estimate_error = true;
  double now = 0;
  const auto clocked = [&](const std::vector<uint32_t>& pixels, uint64_t first, uint32_t count, PixelSums* sums,
                           uint32_t worker) {
    now += 0.05 * static_cast<double>(pixels.size() * count) / (kWidth * kHeight);
    return Quarters{}(pixels, first, count, sums, worker);
  };
  std::optional<SavedRender> saved;
  const Exposure half = expose(settings, 1, clocked,
                               {.clock = [&] { return now; },
                                .stop = [&] { return now > 5; },
                                .save = [&](SavedRender&& state) { saved = std::move(state); }});
  REQUIRE(saved);
  CHECK(saved->has(SampleShares::kSaved));
  const Exposure whole =
      expose(settings, 1, clocked, {.clock = [&] { return now; }, .resume = &*saved, .save = [](SavedRender&&) {}});
  const double last = now;
  CHECK(last == doctest::Approx(10).epsilon(0.05));
  CHECK(mean(whole.samples) == doctest::Approx(2 * mean(half.samples)).epsilon(0.1));
  CHECK(std::ranges::max(whole.samples) > 4 * std::ranges::min(whole.samples));
}

TEST_CASE("allocation: with --time and pixels of one small share, they end with as many samples each, in time") {
  Settings settings = by_noise(kMaxSpp);
  settings.seconds = 10, settings.crop = {0, 0, 16, 16};
  for (const double a_sample : {0.0001, 0.001, 0.02}) {
    CAPTURE(a_sample);
    double now = 0;
    const auto clocked = [&](const std::vector<uint32_t>& pixels, uint64_t first, uint32_t count, PixelSums* sums,
                             uint32_t worker) {
      now += a_sample * static_cast<double>(pixels.size() * count) / (16 * 16);
      return Quarters{}(pixels, first, count, sums, worker);
    };
    const Exposure got = expose(settings, 1, clocked, {.clock = [&] { return now; }});
    CHECK(now == doctest::Approx(10).epsilon(0.02));
    CHECK(std::ranges::max(got.samples) - std::ranges::min(got.samples) <= 1);
  }
}

TEST_CASE(
    "allocation: with --time it draws the first samples of its window alone, whatever the time; or none if it is "
    "stopped") {
  Settings settings = by_noise(kMaxSpp);
  settings.seconds = 1, settings.crop = {10, 9, 20, 21};
  double now = 0;
  uint64_t drawn = 0;
  const auto slow = [&](const std::vector<uint32_t>& pixels, uint64_t first, uint32_t count, PixelSums* sums,
                        uint32_t worker) {
    now += 2.0 * static_cast<double>(pixels.size() * count) / (20 * 21), drawn += pixels.size() * count;
    return Quarters{}(pixels, first, count, sums, worker);
  };
  const Exposure got = expose(settings, 1, slow, {.clock = [&] { return now; }});
  CHECK(drawn == 20 * 21);
  CHECK(std::ranges::max(got.samples) == 1);

  settings.seconds = 0, settings.spp = 16;
  const Exposure stopped = expose(settings, 1, Quarters{}, {.stop = [] { return true; }});
  CHECK(stopped.stopped);
  CHECK(std::ranges::max(stopped.samples) == 0);
}

}  // namespace lanewise
