#include "scenes/quoted.h"

#include <algorithm>

namespace lanewise {

std::string quoted(std::string_view text) {
  constexpr size_t kLongest = 60;
  std::string shown(text.substr(0, kLongest));
  std::ranges::replace_if(
      shown, [](unsigned char c) { return c < ' ' || c == 0x7F; }, '?');
  return '"' + shown + (text.size() > kLongest ? "...\"" : "\"");
}

}  // namespace lanewise
