#include "tools/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/mpi_messenger.h"

namespace lanewise {

namespace {

std::FILE* find_terminal() {
  if (::isatty(STDERR_FILENO)) return stderr;
  std::FILE* terminal = is_launched() ? std::fopen("/dev/tty", "w") : nullptr;
  // Not where mpirun runs in the background, and something else has the terminal.
  if (terminal && ::tcgetpgrp(::fileno(terminal)) != ::getpgid(::getppid())) {
    std::fclose(terminal);
    return nullptr;
  }
  return terminal;
}

}  // namespace

ProgressLine::ProgressLine(bool quiet) : terminal_(quiet ? nullptr : find_terminal()) {}

ProgressLine::~ProgressLine() {
  clear();
  if (terminal_ && terminal_ != stderr) std::fclose(terminal_);
}

void ProgressLine::show(const std::string& text) {
  if (!terminal_) return;
  std::fprintf(terminal_, "\r%s\033[K", text.c_str());
  std::fflush(terminal_);
  shown_ = true;
}

void ProgressLine::show(const Progress& progress) {
  if (terminal_) show(progress_text(progress));
}

void ProgressLine::clear() {
  if (!shown_) return;
  std::fputs("\r\033[K", terminal_);
  std::fflush(terminal_);
  shown_ = false;
}

std::string progress_text(const Progress& p) {
  const double fraction = std::clamp(p.fraction, 0.0, 1.0);
  std::string text = "rendering  ";
  char part[64];
  std::snprintf(part, sizeof part, "%3.0f %%  ", std::floor(100 * fraction));
  text += part;
  constexpr int kBar = 24;
  const int filled = static_cast<int>(kBar * fraction);
  text += "[" + std::string(filled, '=') + std::string(kBar - filled, ' ') + "]";
  if (p.seconds > 0) {
    std::snprintf(part, sizeof part, "  %.1f Mrays/s", 1e-6 * static_cast<double>(p.rays) / p.seconds);
    text += part;
  }
  if (p.mrse >= 0) {
    std::snprintf(part, sizeof part, "  error %.3g %%", 100 * std::sqrt(p.mrse));
    text += part;
  }
  // The first moments say little about the whole.
  if (fraction > 0.001 && p.seconds > 0.5) text += "  " + clock_time(p.seconds * (1 - fraction) / fraction) + " left";
  return text;
}

std::string clock_time(double seconds) {
  const auto whole = static_cast<long long>(std::ceil(std::min(seconds, 1e15)));
  const long long h = whole / 3600, m = whole / 60 % 60, s = whole % 60;
  char text[64];
  if (h > 0) {
    std::snprintf(text, sizeof text, "%lld:%02lld:%02lld", h, m, s);
  } else {
    std::snprintf(text, sizeof text, "%lld:%02lld", m, s);
  }
  return text;
}

}  // namespace lanewise
