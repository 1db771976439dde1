// Draws samples on this process's threads.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/plan.h"
#include "core/plan_light_paths.h"
#include "core/profiler.h"
#include "core/wave.h"

namespace lanewise {

// What some samples took.
struct Drawn {
  uint64_t rays = 0;
  uint64_t invalid_samples = 0;
};

class LocalDraw {
 public:
  // The plan must outlast it.
  LocalDraw(const Plan& plan, uint32_t threads, ProfileDetail detail)
      : plan_(plan), detail_(detail), waves_(threads), splats_(threads) {}

  // Adds samples first .. first + count - 1 of each of the pixels to its sums, on the thread that is called `worker`.
  // slots: pixel j's sums are sums[slots[j]]; null: sums[pixels[j]].
  Drawn draw(const std::vector<uint32_t>& pixels, uint64_t first, uint32_t count, PixelSums* sums, uint32_t worker,
             const uint32_t* slots = nullptr);

  // Hands what the camera sees of these light paths to take(), some at a time, which may leave the list as it likes.
  Drawn draw_light(const LightPiece& piece, uint32_t worker, const std::function<void(Splats&)>& take);

  // While no thread draws; of each that has.
  std::vector<Profile> profiles() const;
  std::vector<std::vector<LoggedCall>> logs() const;

 private:
  Wave& wave(uint32_t worker);

  const Plan& plan_;
  ProfileDetail detail_;
  std::vector<std::unique_ptr<Wave>> waves_;
  std::vector<Splats> splats_;  // of each thread's light paths; empty between calls
};

}  // namespace lanewise
