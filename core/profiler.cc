#include "core/profiler.h"

#include <ctime>

namespace lanewise {
namespace {

// Another address on each thread.
const void* this_thread() {
  static thread_local char here;
  return &here;
}

}  // namespace

Profiler::Clocks Profiler::Clocks::now() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  const auto seconds = static_cast<uint64_t>(time.tv_sec), rest = static_cast<uint64_t>(time.tv_nsec);
  return {Profiler::now(), seconds * 1'000'000'000 + rest, this_thread()};
}

Profiler::Wave::Wave(Profiler& profiler, uint32_t paths) : profiler_(profiler), wave_{.paths = paths} {
  if (!profiler_.detail_.clock) return;
  profiler_.begin_wave();
  wave_.start = now();
}

Profiler::Wave::~Wave() {
  if (!profiler_.detail_.clock) return;
  wave_.nanoseconds = now() - wave_.start;
  profiler_.end_wave(wave_);
}

// Waves mostly follow one another at once; the end of the last then does as the beginning, for the thread's clock is dear.
void Profiler::begin_wave() {
  constexpr uint64_t kAtOnce = 10'000;
  if (since_.thread != this_thread() || now() - since_.wall > kAtOnce) since_ = Clocks::now();
}

void Profiler::end_wave(const LoggedCall& wave) {
  constexpr uint64_t kCalm = 32;  // a wave is calm if its thread waited for less than one part in so many
  const Clocks clocks = Clocks::now();
  const uint64_t wall = clocks.wall - since_.wall, cpu = clocks.cpu - since_.cpu;
  const bool calm = cpu + wall / kCalm >= wall;
  since_ = clocks;
  profile.waves += 1;
  profile.calm_waves += calm;
  profile.wave_nanoseconds += wave.nanoseconds;
  if (calm) profile.calm_wave_nanoseconds += wave.nanoseconds;
  for (const LoggedCall& call : calls_) {
    StageCounter& counter = profile.at(call.stage, call.bounce);
    counter.nanoseconds += call.nanoseconds;
    if (!calm) continue;
    counter.calm_paths += call.paths;
    counter.calm_nanoseconds += call.nanoseconds;
  }
  if (detail_.logged_waves > 0 && log_.size() + calls_.size() < kMostLogged) {
    log_.insert(log_.end(), calls_.begin(), calls_.end());
    log_.push_back(wave);
    --detail_.logged_waves;
  } else {
    detail_.logged_waves = 0;
  }
  calls_.clear();
}

}  // namespace lanewise
