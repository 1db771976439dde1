// --max-memory: an estimate before the work, and a limit that the system keeps during it.
#pragma once

#include <cstdint>
#include <exception>
#include <string>

#include "core/plan.h"
#include "tools/render_options.h"

namespace lanewise {

// From now on the program's data, all threads' and their stacks included, stays within that; 0: as it is. What would exceed it
// is std::bad_alloc. Builds with sanitizers, whose own data would, are not held.
void hold_memory_to(uint64_t bytes);

// Throws Error, saying what needs how much and what would need less, if a render of the plan does not fit in --max-memory. Before
// the render, when all is loaded.
void check_memory(const RenderOptions& options, const Plan& plan);

// Whether it tells of memory that there was not. OpenEXR makes its own exceptions of std::bad_alloc.
bool is_of_memory(const std::exception& failure);
// What to say then.
std::string memory_complaint();

}  // namespace lanewise
