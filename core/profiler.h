// Counts the calls of one thread's wave as they happen, and clocks and logs them if asked to.
#pragma once

#include <chrono>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "core/profile.h"
#include "core/stages.h"

namespace lanewise {

// Counting is always on. What is more costs some 60 ns a call and 1 us a wave.
struct ProfileDetail {
  bool clock = false;         // the times of Profile
  uint32_t logged_waves = 0;  // of each thread, the first so many leave their calls in a log; needs the clock
};

// One call. Stage::kCount: a wave as a whole.
struct LoggedCall {
  uint64_t start = 0;  // nanoseconds of std::chrono::steady_clock
  uint64_t nanoseconds = 0;
  Stage stage = Stage::kCount;
  uint32_t bounce = 0;
  uint32_t paths = 0;
};

class Profiler {
 public:
  static constexpr size_t kMostLogged = 100'000;  // calls, whatever logged_waves says: waves of deep paths have many

  // Each lasts as long as what it clocks.
  class Call {
   public:
    Call(Profiler& profiler, const LoggedCall& call) : profiler_(profiler), call_(call) {
      if (profiler_.detail_.clock) call_.start = now();
    }
    ~Call() {
      if (!profiler_.detail_.clock) return;
      call_.nanoseconds = now() - call_.start;
      profiler_.calls_.push_back(call_);
    }
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;

   private:
    Profiler& profiler_;
    LoggedCall call_;
  };
  class Wave {
   public:
    Wave(Profiler& profiler, uint32_t paths);
    ~Wave();
    Wave(const Wave&) = delete;
    Wave& operator=(const Wave&) = delete;

   private:
    Profiler& profiler_;
    LoggedCall wave_;
  };

  explicit Profiler(ProfileDetail detail) : detail_(detail) {}

  Wave wave(uint32_t paths) { return Wave(*this, paths); }
  // Within a wave. paths: living; lanes: run.
  Call call(Stage stage, uint32_t bounce, uint32_t paths, uint32_t lanes) {
    StageCounter& counter = profile.at(stage, bounce);
    counter.calls += 1;
    counter.paths += paths;
    counter.lanes += lanes;
    counter.lengths.add(paths);
    return Call(*this, {.stage = stage, .bounce = bounce, .paths = paths});
  }

  const std::vector<LoggedCall>& log() const { return log_; }  // by the time that calls ended

  Profile profile;

 private:
  static uint64_t now() {
    static_assert(std::is_same_v<std::chrono::steady_clock::period, std::nano>);
    return static_cast<uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
  }
  // Where a thread's two clocks stand: what it waited in between is the difference of their differences.
  struct Clocks {
    uint64_t wall = 0;
    uint64_t cpu = 0;  // time that the thread has run
    const void* thread = nullptr;

    static Clocks now();
  };
  void begin_wave();
  void end_wave(const LoggedCall& wave);

  ProfileDetail detail_;
  Clocks since_;                   // of the wave that runs, or the end of the last
  std::vector<LoggedCall> calls_;  // of the wave that runs
  std::vector<LoggedCall> log_;
};

}  // namespace lanewise
