// Names from files, as messages show them.
#pragma once

#include <string>
#include <string_view>

namespace lanewise {

// A one-line, printable, short form of text that comes from a file.
std::string quoted(std::string_view text);

}  // namespace lanewise
