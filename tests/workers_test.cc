#include "core/workers.h"

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <new>
#include <stdexcept>
#include <thread>

#include "core/schedule.h"
#include "core/types.h"
#include "tests/made_up_draw.h"

namespace lanewise {

TEST_CASE("workers: the first failure is thrown again, and no further item starts") {
  for (const uint32_t threads : {1u, 2u, 8u}) {
    CAPTURE(threads);
    std::atomic<size_t> started{0};
    std::atomic<bool> failed{false};
    std::string what;
    try {
      run_workers(
          threads, 1'000'000,
          [&](size_t item, uint32_t) -> uint64_t {
            ++started;
            if (item == 0) {
              while (started < threads) std::this_thread::yield();
              failed = true;
              throw Error("first");
            }
            while (!failed) std::this_thread::yield();
            // Of those that are under way some fail too, later; the others would go on.
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            if (item % 2 == 1) throw Error("later");
            return 0;
          },
          nullptr);
    } catch (const Error& e) {
      what = e.what();
    }
    CHECK(what == "first");
    CHECK(started <= threads);
  }
}

TEST_CASE("workers: a failure of whoever waits ends the work, too") {
  std::atomic<size_t> started{0};
  const auto body = [&](size_t, uint32_t) {
    ++started;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return uint64_t{0};
  };
  CHECK_THROWS_AS(run_workers(2, 1000, body, [](const Progress&) { throw Error("enough"); }), Error);
  CHECK(started < 100);
}

TEST_CASE("workers: what a draw throws comes out of the render, of every kind, and nothing is saved after it") {
  for (const bool memory : {true, false}) {
    for (int mode = 0; mode < 3; ++mode) {
      CAPTURE(mode);
      Settings settings;
      settings.width = settings.height = 64;
      settings.spp = 100'000;
      settings.estimate_error = true;
      if (mode == 1) settings.noise = 0.001;
      if (mode == 2) settings.adaptive_batch = 16;
      const test::MadeUpDraw made_up;
      std::atomic<int> draws{0};
      std::atomic<bool> failed{false};
      const Draw draw = [&](const std::vector<uint32_t>& pixels, uint64_t first, uint32_t count, PixelSums* sums,
                            uint32_t worker) -> uint64_t {
        if (++draws > 20) {
          failed = true;
          if (memory) throw std::bad_alloc();
          throw Error("a draw failed");
        }
        return made_up(pixels, first, std::min(count, 4u), sums, worker);
      };
      int saves = 0;
      const RenderControl control{.save =
                                      [&](SavedRender&&) {
                                        CHECK_FALSE(failed);
                                        ++saves;
                                      },
                                  .save_every = 1e-9};
      if (memory) {
        CHECK_THROWS_AS(expose(settings, 4, draw, control), std::bad_alloc);
      } else {
        CHECK_THROWS_WITH_AS(expose(settings, 4, draw, control), "a draw failed", Error);
      }
      CHECK(draws <= 20 + 4);
    }
  }
}

}  // namespace lanewise
