// Scripts that complete the command line in a shell. A flag's values are completed where they are choices or files.
#pragma once

#include <string>

#include "tools/command_model.h"

namespace lanewise {

std::string bash_completions(const Command& program);
std::string zsh_completions(const Command& program);
std::string fish_completions(const Command& program);

}  // namespace lanewise
