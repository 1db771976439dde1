// What `lanewise --version` tells.
#pragma once

#include <string>

namespace lanewise {

// "lanewise 0.1.0", then lines on how it was built, on its instruction sets and on its libraries.
std::string version_report();

}  // namespace lanewise
