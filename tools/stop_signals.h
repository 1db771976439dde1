// SIGINT and SIGTERM end a render early rather than the program.
#pragma once

namespace lanewise {

// While it lives, the first of them is only noted; the second ends the program, as if nothing had been done about it.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  static int received();  // the signal's number; 0: none. From any thread.
};

// What a command throws that a signal has ended early, when all is written.
struct Stopped {
  int signal;
};

// Ends the program as the signal would have.
[[noreturn]] void die_of(int signal);

}  // namespace lanewise
