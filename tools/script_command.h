// Commands of the program whose work is done by a script in perf/: these hand over to it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace lanewise {

// A command all of whose arguments, --help too, are those of perf/<name>.py, which takes the place of this process and finds
// the program in LANEWISE_BINARY.
void add_script_command(CLI::App& app, const std::string& name, const std::string& description);

}  // namespace lanewise
