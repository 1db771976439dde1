#include <string_view>

#include "tools/completions.h"

namespace lanewise {
namespace {

constexpr const char* kHead = R"(#compdef lanewise
# Completions of lanewise for zsh, made by `lanewise generate zsh`.

# One of the words, or a file.
_lanewise_either() {
  local -a words=(${=1})
  compadd -a words
  _files ${@:2}
}

)";

std::string escaped(const std::string& text, std::string_view special) {
  std::string escaped;
  for (const char c : text) {
    if (special.find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

// As a word of a script.
std::string in_quotes(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

// As _arguments takes it: what completes a value.
std::string action(const Flag& flag) {
  std::string pattern;
  if (!flag.extensions.empty()) pattern = " -g \"*.(#i)(" + join(flag.extensions, "|") + ")(-.)\"";
  const std::string words = escaped(join(flag.words, " "), "\\:");
  if (flag.is_file && !flag.words.empty()) return " _lanewise_either \"" + words + "\"" + pattern;
  if (flag.is_file) return "_files" + pattern;
  return flag.words.empty() ? " " : "(" + words + ")";
}

// ":W: :H: ", for each of the flag's values.
std::string values_of(const Flag& flag) {
  if (flag.value_count == kAnyNumber) return ":*:" + escaped(flag.values, "\\:") + ":" + action(flag);
  std::string text;
  std::string_view names = flag.values;
  for (size_t i = 0; i < flag.value_count; ++i) {
    const size_t end = i + 1 < flag.value_count ? names.find(' ') : std::string_view::npos;
    text += ":" + escaped(std::string(names.substr(0, end)), "\\:") + ":" + action(flag);
    if (end != std::string_view::npos) names.remove_prefix(end + 1);
  }
  return text;
}

// (-s --spp){-s+,--spp=}[what it does]:N:
std::string spec_of(const Flag& flag) {
  std::string names;
  for (const std::string& name : flag.names) {
    const char* value = flag.value_count == 0 ? "" : name.starts_with("--") ? "=" : "+";
    names += (names.empty() ? "" : ",") + name + value;
  }
  const std::string rest = "[" + escaped(flag.description, "[]\\:") + "]" + values_of(flag);
  if (flag.names.size() == 1) return in_quotes(names + rest);
  return in_quotes("(" + join(flag.names, " ") + ")") + "{" + names + "}" + in_quotes(rest);
}

std::string arguments_of(const Command& command) {
  std::string text = "_arguments -S";
  for (const Flag& flag : command.flags) text += " \\\n    " + spec_of(flag);
  for (const Flag& argument : command.arguments) {
    for (size_t i = 0; i < argument.value_count; ++i) {
      const bool any = argument.value_count == kAnyNumber;
      text += " \\\n    " + in_quotes((any ? "*" : "") + std::string(argument.required || any ? ":" : "::") +
                                      escaped(argument.label, "\\:") + ":" + action(argument));
      if (any) break;
    }
  }
  return text;
}

}  // namespace

std::string zsh_completions(const Command& program) {
  std::string text = kHead, commands, cases;
  for (const Command& command : program.commands) {
    const std::string function = "_lanewise_" + command.name;
    text += function + "() {\n  " + (command.passes_on ? "_default" : arguments_of(command)) + "\n}\n\n";
    commands += "      " + in_quotes(command.name + ":" + command.description) + "\n";
  }
  return text +
         "_lanewise() {\n"
         "  local state line context\n"
         "  typeset -A opt_args\n"
         "  " +
         arguments_of(program) + " \\\n    -C ':command:->command' '*::argument:->argument'\n" + R"(
  case $state in
    command)
      local -a commands=(
)" + commands +
         R"(      )
      _describe command commands
      ;;
    argument) (( ! $+functions[_lanewise_$line[1]] )) || _lanewise_$line[1] ;;
  esac
}

_lanewise "$@"
)";
}

}  // namespace lanewise
