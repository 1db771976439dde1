// Metals by name, for --metal.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace lanewise {

struct Metal {
  std::vector<std::string> names;  // the symbol first
  glm::dvec3 eta;                  // index of refraction at 614, 549 and 466 nm
  glm::dvec3 k;                    // extinction coefficient there
};

const std::vector<Metal>& metals();

// By any of its names, in any case; nullptr if there is none.
const Metal* find_metal(const std::string& name);

}  // namespace lanewise
