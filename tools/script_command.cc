#include "tools/script_command.h"

#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "core/types.h"

namespace lanewise {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPython = "/usr/bin/python3";  // Debian's, which has Debian's matplotlib

fs::path own_path() {
  std::error_code error;
  const fs::path path = fs::read_symlink("/proc/self/exe", error);
  if (error) throw Error("/proc/self/exe: " + error.message());
  return path;
}

// In share/lanewise beside the program's folder, where it is installed, or within it, which in a build is the checkout.
fs::path find_script(const fs::path& program, const std::string& name) {
  const fs::path script = "share/lanewise/perf/" + name + ".py";
  const fs::path folder = program.parent_path(), places[] = {folder.parent_path() / script, folder / script};
  for (const fs::path& path : places) {
    if (fs::exists(path)) return path;
  }
  throw Error(places[0].string() + ": is not there; lanewise " + name + " needs the scripts in perf/");
}

void run_script(const std::string& name, const std::vector<std::string>& arguments) {
  const fs::path program = own_path();
  const std::string script = find_script(program, name).string();
  if (::access(kPython, X_OK) != 0) {
    throw Error(std::string(kPython) + ": is not there; lanewise " + name +
                " needs Debian's python3-matplotlib, python3-numpy and python3-pil");
  }
  ::setenv("LANEWISE_BINARY", program.c_str(), 1);  // the program that is measured is this one
  // -B: no compiled files beside the scripts, which no package would know of.
  std::vector<char*> argv = {const_cast<char*>(kPython), const_cast<char*>("-B"), const_cast<char*>(script.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  std::cout.flush();
  for (const int signal : {SIGXFSZ, SIGPIPE})
    std::signal(signal, SIG_DFL);  // that main() ignores: not what others expect
  ::execv(kPython, argv.data());
  throw Error(std::string(kPython) + ": " + std::strerror(errno));
}

}  // namespace

void add_script_command(CLI::App& app, const std::string& name, const std::string& description) {
  CLI::App* command = app.add_subcommand(name, description);
  command->group("Commands");
  // Every argument, --help too, is the script's.
  command->set_help_flag();
  command->prefix_command();
  command->callback([name, command] { run_script(name, command->remaining()); });
}

}  // namespace lanewise
