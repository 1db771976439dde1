#include "tools/stop_signals.h"

#include <atomic>
#include <csignal>
#include <cstdlib>

namespace lanewise {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM};

std::atomic<int> seen{0};
static_assert(std::atomic<int>::is_always_lock_free, "for the handler");

void note(int signal) { seen = signal; }

}  // namespace

StopSignals::StopSignals() {
  seen = 0;
  struct sigaction action {};
  action.sa_handler = note;
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  for (const int signal : kSignals) ::sigaction(signal, &action, nullptr);
}

StopSignals::~StopSignals() {
  for (const int signal : kSignals) std::signal(signal, SIG_DFL);
}

int StopSignals::received() { return seen; }

void die_of(int signal) {
  std::signal(signal, SIG_DFL);
  std::raise(signal);
  std::abort();
}

}  // namespace lanewise
