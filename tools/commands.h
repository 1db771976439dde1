// The commands of the program: each adds itself to the parser and runs from within its parse.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace lanewise {

// command_line: as typed, to be kept with what a render writes.
void add_render_command(CLI::App& app, const std::string& command_line);
void add_profile_command(CLI::App& app, const std::string& command_line);
void add_plan_command(CLI::App& app, const std::string& command_line);
void add_info_command(CLI::App& app);
void add_convert_command(CLI::App& app);
void add_merge_command(CLI::App& app);
void add_compare_command(CLI::App& app);
void add_verify_command(CLI::App& app);
void add_generate_command(CLI::App& app);  // of the man page and completions, from what the others have added

}  // namespace lanewise
