// Instruction sets: which the program holds, which this machine can run, and the choice among them.
#pragma once

#include <string>
#include <vector>

namespace lanewise {

// "scalar", "sse4", "avx2", "avx512": those compiled in, best last.
std::vector<std::string> compiled_isas();
// Those of them that this machine can run.
std::vector<std::string> supported_isas();
// Chooses one for all kernels from now on; "" means the best. Throws UsageError for a name that is unknown or not
// supported here. Process-wide: call before threads start.
void choose_isa(const std::string& name);
std::string chosen_isa();

}  // namespace lanewise
