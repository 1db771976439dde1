#include "tools/completions.h"

namespace lanewise {
namespace {

constexpr const char* kHead = R"(# Completions of lanewise for fish, made by `lanewise generate fish`.

# Files that end in one of the extensions, in either case, and folders.
function __lanewise_files
    set -l found (complete -C "__lanewise_no_command "(commandline -ct))
    string match -r -- '^.*/$' $found
    string match -ri -- '^.*\.(?:'(string join '|' $argv)')$' $found
end

complete -c lanewise -f
)";

std::string in_quotes(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += (c == '\'' || c == '\\' ? "\\" : "") + std::string(1, c);
  return word + "'";
}

// What completes a value: -f alone is nothing.
std::string values_of(const Flag& flag) {
  if (flag.is_file && flag.extensions.empty() && flag.words.empty()) return " -F";
  std::string values = join(flag.words, " ");
  if (flag.is_file) {
    values += (values.empty() ? "" : " ") + ("(__lanewise_files " + join(flag.extensions, " ") + ")");
  }
  return values.empty() ? "" : " -f -k -a " + in_quotes(values);
}

std::string line(const std::string& condition) { return "complete -c lanewise -n " + in_quotes(condition); }

std::string lines_of(const Command& command, const std::string& condition) {
  std::string text;
  for (const Flag& flag : command.flags) {
    text += line(condition);
    for (const std::string& name : flag.names) {
      const bool is_long = name.starts_with("--");
      text += (is_long ? " -l " : " -s ") + name.substr(is_long ? 2 : 1);
    }
    if (flag.value_count > 0) text += " -r" + (flag.is_file ? "" : std::string(" -f")) + values_of(flag);
    text += " -d " + in_quotes(flag.description) + "\n";
  }
  // Fish does not tell arguments apart by their places: what one may be, each may.
  std::string last;
  for (const Flag& argument : command.arguments) {
    const std::string values = values_of(argument);
    if (values != last) text += line(condition) + values + "\n";
    last = values;
  }
  return text;
}

}  // namespace

std::string fish_completions(const Command& program) {
  const std::string none_yet = "__fish_use_subcommand";
  std::string text = kHead + lines_of(program, none_yet);
  for (const Command& command : program.commands) {
    text += line(none_yet) + " -a " + command.name + " -d " + in_quotes(command.description) + "\n";
  }
  for (const Command& command : program.commands) {
    const std::string given = "__fish_seen_subcommand_from " + command.name;
    text += "\n" + (command.passes_on ? line(given) + " -F\n" : lines_of(command, given));
  }
  return text;
}

}  // namespace lanewise
