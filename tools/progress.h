// One line on a terminal, updated in place: standard error, or, as mpirun's ranks have none there, the one that it was started from.
// Nothing where there is none.
#pragma once

#include <cstdio>
#include <string>

#include "core/render.h"

namespace lanewise {

// "rendering", percentage, bar, rays per second, estimated relative error (root of MRSE) and time left, as far as known.
std::string progress_text(const Progress& progress);

class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const std::string& text);
  void show(const Progress& progress);
  void clear();

 private:
  std::FILE* terminal_;  // null: none
  bool shown_ = false;
};

// "0:42", "12:07", "3:04:05"; fractions of a second are rounded up.
std::string clock_time(double seconds);

}  // namespace lanewise
