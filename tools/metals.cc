#include "tools/metals.h"

#include <algorithm>
#include <cctype>

namespace lanewise {
namespace {

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

const std::vector<Metal>& metals() {
  static const std::vector<Metal> table = {
      {{"Au", "gold"}, {0.21646, 0.42833, 1.3284}, {3.2390, 2.4599, 1.8661}},
      {{"Cu", "copper"}, {0.33228, 1.0162, 1.2474}, {3.1646, 2.5785, 2.4603}},
      {{"Al", "aluminium", "aluminum"}, {1.3352, 1.0109, 0.68955}, {7.3398, 6.6157, 5.6471}},
      {{"Ag", "silver"}, {0.059193, 0.059881, 0.047366}, {4.1283, 3.5892, 2.8132}},
      {{"brass"}, {0.45080, 0.52920, 0.93760}, {3.3806, 2.7553, 1.9274}},
      {{"Ca", "calcium"}, {0.29294, 0.28568, 0.28733}, {2.7181, 2.3479, 1.8333}},
      // Johnson and Christy, Phys. Rev. B 9, 5056 (1974), between their wavelengths.
      {{"Cr", "chromium"}, {3.1743, 3.1800, 2.4650}, {3.3000, 3.3300, 3.2150}},
      // Seen in print: chromium's k with gold's eta. Kept to reproduce pictures made with it.
      {{"cr-printed"}, {0.21646, 0.42833, 1.3284}, {3.3000, 3.3300, 3.2150}},
      {{"Hg", "mercury"}, {1.8795, 1.5472, 1.1353}, {5.1076, 4.6437, 3.9980}},
  };
  return table;
}

const Metal* find_metal(const std::string& name) {
  const std::string wanted = lower_case(name);
  for (const Metal& metal : metals()) {
    for (const std::string& known : metal.names) {
      if (lower_case(known) == wanted) return &metal;
    }
  }
  return nullptr;
}

}  // namespace lanewise
