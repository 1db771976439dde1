// What goes on around a render while it draws: progress, an end before its time, and saving what there is.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>

#include "core/saved_render.h"

namespace lanewise {

struct Progress {
  double fraction = 0;  // of the work that is known of, or of the time that --time gives it, in [0, 1]
  uint64_t rays = 0;
  double seconds = 0;
  double mrse = -1;  // estimated error of the picture so far; -1: not known yet
};

// Seconds since some moment, to be called from any thread.
using Clock = std::function<double()>;
double steady_seconds();

class RemoteRanks;

struct RenderControl {
  std::function<void(const Progress&)> progress = nullptr;  // some ten times a second, from the thread that renders
  Clock clock = steady_seconds;
  std::function<bool()> stop = nullptr;  // from any thread, often; once true: draws no more than it has begun
  const SavedRender* resume = nullptr;   // what to go on with; must outlast the render
  std::function<void(SavedRender&&)> save = nullptr;  // from the thread that renders: while it draws, and at its end
  double save_every = 0;                              // seconds between two saves; 0: only at the end
  RemoteRanks* remote = nullptr;                      // other processes that draw, too
};

// When a render draws, and when it pauses to be saved. The clock may stand still, and may jump: what it falls back by is taken for
// no time at all, so that neither an end nor a save is put off by it.
class Intervals {
 public:
  explicit Intervals(const RenderControl& control)
      : control_(control), last_(control.clock()), passed_(control.resume ? control.resume->seconds : 0) {
    saved_ = passed_;
  }

  // Seconds of drawing, with what was before a resume; never less than the last time. From any thread.
  double elapsed() const {
    const std::lock_guard lock(mutex_);
    const double now = control_.clock();
    if (now > last_) passed_ += now - last_;
    last_ = now;
    return passed_;
  }
  bool stopped() const { return control_.stop && control_.stop(); }
  bool save_due() const {
    return drew_ && control_.save && control_.save_every > 0 && elapsed() - saved_ >= control_.save_every;
  }
  // From any thread, when some work is done. Without any since the last save no other is due: however short the time between
  // two, a render gets on.
  void drew() { drew_ = true; }
  // From any thread: that no further work is to begin, for now or for good.
  bool pausing() const { return stopped() || save_due(); }

  // state(): a SavedRender. Between two pieces of work.
  template <class F>
  void save(const F& state) {
    if (!control_.save) return;
    SavedRender saved = state();
    saved.seconds = elapsed();
    control_.save(std::move(saved));
    saved_ = elapsed();
    drew_ = false;
  }

 private:
  const RenderControl& control_;
  mutable std::mutex mutex_;  // guards the two below
  mutable double last_;       // that the clock has told
  mutable double passed_;
  double saved_ = 0;  // when
  std::atomic<bool> drew_{false};
};

}  // namespace lanewise
