// The manual page.
#pragma once

#include <string>

#include "tools/command_model.h"

namespace lanewise {

// In groff's man macros.
std::string man_page(const Command& program);

}  // namespace lanewise
