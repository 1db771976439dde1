#include "tools/text.h"

#include <cstdarg>
#include <cstdio>

namespace lanewise {

std::string print(const char* format, ...) {
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  const int length = std::vsnprintf(nullptr, 0, format, arguments);
  std::string text(static_cast<size_t>(length), ' ');
  std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  va_end(arguments);
  return text;
}

std::string short_count(double n) {
  const char* unit = "";
  for (const char* larger : {" k", " M", " G", " T"}) {
    if (n < 999.5) break;
    n /= 1000;
    unit = larger;
  }
  return print("%.3g%s", n, unit);
}

}  // namespace lanewise
