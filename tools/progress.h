// One line on a terminal, updated in place; nothing where standard error is not one.
#pragma once

#include <string>

#include "core/render.h"

namespace lanewise {

// "rendering", percentage, bar, rays per second, estimated relative error (root of MRSE) and time left, as far as known.
std::string progress_text(const Progress& progress);

class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const std::string& text);
  void show(const Progress& progress);
  void clear();

 private:
  bool enabled_;
  bool shown_ = false;
};

// "0:42", "12:07", "3:04:05"; fractions of a second are rounded up.
std::string clock_time(double seconds);

}  // namespace lanewise
