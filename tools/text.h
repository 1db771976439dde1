// Text of numbers.
#pragma once

#include <string>

namespace lanewise {

// As printf prints it.
[[gnu::format(printf, 1, 2)]] std::string print(const char* format, ...);

// "842", "12.3 k", "4.56 M".
std::string short_count(double n);

}  // namespace lanewise
