// What a plan specialised for its scene and settings, and why: for `lanewise plan`, and for the records of runs. All of it
// is read off the plan.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/plan.h"

namespace lanewise {

enum class FigureUnit { kCount, kBytes, kShare };  // kShare: in [0, 1]

struct Figure {
  const char* name;  // in snake case
  double value;
  FigureUnit unit = FigureUnit::kCount;
};

struct Decision {
  std::string topic;    // "stages", "light", "state", "geometry", "trees" or "memory", in this order
  std::string subject;  // what is decided on: a stage, a mesh, a tree, ...
  std::string choice;
  std::string reason;
  std::vector<Figure> figures;
};

std::vector<Decision> explain(const Plan& plan);

// Bytes that a render takes, without stacks, the program, and the loader's peak.
struct MemoryNeed {
  size_t scene = 0;
  size_t film = 0;
  size_t paths = 0;  // of all threads
  size_t files = 0;  // for a while: the error's estimate, a checkpoint's copies of the film, what is encoded

  size_t all() const { return scene + film + paths + files; }
};

// saved: whether there is a checkpoint, or a film file is written.
MemoryNeed memory_need(const Plan& plan, bool saved);

// In one line.
std::string one_line(const Decision& decision);

// Why the wave never calls the stage, in words; empty if it does wherever paths meet what it is for.
std::string why_left_out(const Plan& plan, Stage stage);

}  // namespace lanewise
