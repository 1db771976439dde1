// Which instruction sets the program holds; those that this machine has, and the choice among them, are in core/render.h.
#pragma once

#include <string>
#include <vector>

namespace lanewise {

// That it was compiled for, worst first.
std::vector<std::string> compiled_isas();

}  // namespace lanewise
