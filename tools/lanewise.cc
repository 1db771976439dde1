// The program: finds the command, and turns every failure into one line and an exit code: 1 for files and the machine,
// 2 for the command line. A pipe that nobody reads any more ends it as it ends other programs, by SIGPIPE and in silence, but
// only when all files are written.
#include <csignal>
#include <exception>
#include <iostream>
#include <memory>
#include <string>

#include "core/file.h"
#include "core/types.h"
#include "tools/commands.h"
#include "tools/flags.h"
#include "tools/memory_limit.h"
#include "tools/script_command.h"
#include "tools/standard_streams.h"
#include "tools/stop_signals.h"
#include "tools/version_report.h"

namespace lanewise {
namespace {

bool has_command(CLI::App& app, const std::string& name) {
  return !app.get_subcommands([&](CLI::App* command) { return command->get_name() == name; }).empty();
}

void run(int argc, char** argv) {
  CLI::App app("Lanewise, a wavefront path tracer for the CPU", "lanewise");
  app.formatter(std::make_shared<HelpFormatter>());
  app.set_help_flag("-h,--help", "Print this help");
  app.set_version_flag("-V,--version", version_report,
                       "Print the version, how it was built, instruction sets and libraries");
  app.require_subcommand(0, 1);
  app.footer("lanewise COMMAND --help tells more.");
  add_render_command(app, quoted_command_line(argc, argv));
  add_profile_command(app, quoted_command_line(argc, argv));
  add_plan_command(app, quoted_command_line(argc, argv));
  add_info_command(app);
  add_convert_command(app);
  add_merge_command(app);
  add_compare_command(app);
  add_script_command(app, "chart", "Chart error against seconds of rendering, beside other renderers");
  add_script_command(app, "replay", "Render the pictures of the course's write-ups, and measure their claims");
  add_verify_command(app);
  add_generate_command(app);

  if (argc > 1 && argv[1][0] != '-' && !has_command(app, argv[1])) {
    throw UsageError("'" + std::string(argv[1]) + "' is not a command; see lanewise --help");
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    app.exit(help_or_version);
  } catch (const CLI::ArgumentMismatch& e) {
    const std::string text = e.what();  // begins with the flag
    throw UsageError(text.substr(0, text.find(':')) + ": a value is missing; see --help");
  } catch (const CLI::ParseError& e) {
    throw UsageError(e.what());
  }
  if (argc == 1) std::cout << app.help();
}

// Always one line: file names may hold anything.
int complain(std::string text, int exit_code) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  std::cerr << "lanewise: " << text << std::endl;
  return exit_code;
}

}  // namespace
}  // namespace lanewise

int main(int argc, char** argv) {
  using lanewise::complain;
  lanewise::open_standard_streams();
  // A file that outgrows its limit, and a pipe that nobody reads, are then errors of a write like any other.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  try {
    lanewise::StandardOutput output;
    lanewise::run(argc, argv);
    output.finish();
    return 0;
  } catch (const lanewise::BrokenPipe&) {
    lanewise::die_of(SIGPIPE);
  } catch (const lanewise::Stopped& stopped) {
    lanewise::die_of(stopped.signal);
  } catch (const lanewise::UsageError& e) {
    return complain(e.what(), 2);
  } catch (const std::exception& e) {
    return complain(lanewise::is_of_memory(e) ? lanewise::memory_complaint() : e.what(), 1);
  } catch (...) {
    return complain("unknown error", 1);
  }
}
