// The libraries that the program is made with.
#pragma once

#include <string>
#include <vector>

namespace lanewise {

struct Library {
  std::string name;
  std::string version;  // of the one that is loaded, where it tells; else of its headers
};

std::vector<Library> libraries();

}  // namespace lanewise
