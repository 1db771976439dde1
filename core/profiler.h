// Counts the calls of one thread's wave as they happen, and clocks and logs them if asked to.
#pragma once

#include <chrono>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "core/profile.h"
#include "core/stages.h"

namespace lanewise {

// Counting is always on. What is more costs some 50 ns a call.
struct ProfileDetail {
  bool clock = false;         // the nanoseconds of Profile
  uint32_t logged_waves = 0;  // of each thread, the first so many leave their calls in a log
};

// One call in the log. Stage::kCount: a wave as a whole.
struct LoggedCall {
  uint64_t start = 0;  // nanoseconds of std::chrono::steady_clock
  uint64_t nanoseconds = 0;
  Stage stage = Stage::kCount;
  uint32_t bounce = 0;
  uint32_t paths = 0;
};

class Profiler {
  using Clock = std::chrono::steady_clock;
  static_assert(std::is_same_v<Clock::period, std::nano>);

 public:
  static constexpr size_t kMostLogged = 100'000;  // calls, whatever logged_waves says: waves of deep paths have many

  // Lasts as long as what it clocks.
  class Clocked {
   public:
    Clocked(Profiler& profiler, uint64_t& sum, const LoggedCall& call) : profiler_(profiler), sum_(sum), call_(call) {
      if (profiler_.detail_.clock) call_.start = now();
    }
    ~Clocked() {
      if (!profiler_.detail_.clock) return;
      call_.nanoseconds = now() - call_.start;
      sum_ += call_.nanoseconds;
      profiler_.log(call_);
    }
    Clocked(const Clocked&) = delete;
    Clocked& operator=(const Clocked&) = delete;

   private:
    Profiler& profiler_;
    uint64_t& sum_;
    LoggedCall call_;
  };

  explicit Profiler(ProfileDetail detail) : detail_(detail) {}

  // paths: living; lanes: run.
  Clocked call(Stage stage, uint32_t bounce, uint32_t paths, uint32_t lanes) {
    StageCounter& counter = profile.at(stage, bounce);
    counter.calls += 1;
    counter.paths += paths;
    counter.lanes += lanes;
    counter.lengths.add(paths);
    return Clocked(*this, counter.nanoseconds, {.stage = stage, .bounce = bounce, .paths = paths});
  }
  Clocked wave(uint32_t paths) { return Clocked(*this, profile.wave_nanoseconds, {.paths = paths}); }

  const std::vector<LoggedCall>& log() const { return log_; }

  Profile profile;

 private:
  static uint64_t now() { return static_cast<uint64_t>(Clock::now().time_since_epoch().count()); }

  void log(const LoggedCall& call) {
    if (detail_.logged_waves == 0 || log_.size() >= kMostLogged) return;
    log_.push_back(call);
    if (call.stage == Stage::kCount) --detail_.logged_waves;  // a wave ends after its calls
  }

  ProfileDetail detail_;
  std::vector<LoggedCall> log_;
};

}  // namespace lanewise
