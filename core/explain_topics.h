// The topics of explain(), each of which appends its decisions.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/explain.h"

namespace lanewise {

void explain_stages(const Plan& plan, std::vector<Decision>& out);
void explain_light(const Plan& plan, std::vector<Decision>& out);
void explain_state(const Plan& plan, std::vector<Decision>& out);
void explain_geometry(const Plan& plan, std::vector<Decision>& out);  // and trees
void explain_memory(const Plan& plan, std::vector<Decision>& out);

// "1 light", "3 lights".
inline std::string count_of(uint64_t n, const std::string& what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

// Primitives of a leaf block, without the lanes that fill it up: those repeat its first or hold kNoPrim.
template <class Block>
uint32_t block_size(const Block& block) {
  uint32_t n = 1;
  for (uint32_t lane = 1; lane < kLeafWidth; ++lane) {
    n += block.prim[lane] != block.prim[0] && block.prim[lane] != kNoPrim;
  }
  return n;
}

}  // namespace lanewise
