#include <algorithm>
#include <utility>

#include "tools/completions.h"

namespace lanewise {
namespace {

constexpr const char* kHead = R"(# Completions of lanewise for bash, made by `lanewise generate bash`.

)";

// Looks the word at the cursor up in the tables before it. The words to its left are taken one by one: a flag and so many
// values, else the command, and then the command's arguments. Bash splits --flag=value at the = into three words.
constexpr const char* kSearch = R"(
# Adds the folders that WORD begins, and the files that end in one of the extensions, in either case; without any all files.
_lanewise_files() {
  local word=${1#[\"\']} name ending
  word=${word//\\/}
  compopt -o filenames 2>/dev/null
  while IFS= read -r name; do
    ending=${name##*.}
    if [[ $# == 1 || " ${*:2} " == *" ${ending,,} "* || -d ${name/#\~\//$HOME/} ]]; then
      COMPREPLY+=("$name")
    fi
  done < <(compgen -f -- "$word")
}

_lanewise() {
  local current=${COMP_WORDS[COMP_CWORD]} command= flag= left=0 place=0 flags values words files word
  [[ $current == = ]] && current=
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    if [[ $word == = ]]; then
      continue
    elif ((left > 0)) && [[ $values != any || $word != -* ]]; then
      [[ $values == any ]] || ((--left))
    elif [[ $word == -* ]]; then
      flag=$word
      _lanewise_takes "$command $flag"
      left=${values/any/1}
    elif [[ -z $command ]]; then
      command=$word
    else
      ((++place))
    fi
  done

  COMPREPLY=()
  words= files=
  _lanewise_knows "$command"
  if [[ $words == '(its own)' ]]; then
    compopt -o default 2>/dev/null
    return
  elif ((left > 0)) && [[ $values != any || $current != -* ]]; then
    _lanewise_takes "$command $flag"
  elif [[ $current == -* ]]; then
    words=$flags
  elif [[ -n $command ]]; then
    _lanewise_takes "$command $place"
  fi
  [[ -z $words ]] || COMPREPLY=($(compgen -W "$words" -- "$current"))
  [[ -z $files ]] || _lanewise_files "$current" ${files/any/}
}

complete -F _lanewise lanewise
)";

// Keys of a case with what is done for them: those that do the same stand together.
class Cases {
 public:
  void add(const std::string& key, const std::string& body) {
    const auto same = std::find_if(cases_.begin(), cases_.end(), [&](const auto& c) { return c.second == body; });
    if (same == cases_.end()) {
      add_pattern("'" + key + "'", body);
    } else {
      same->first += " | '" + key + "'";
    }
  }

  // Of what no key before it is.
  void add_pattern(const std::string& pattern, const std::string& body) { cases_.emplace_back(pattern, body); }

  std::string text() const {
    std::string text = "  case $1 in\n";
    for (const auto& [keys, body] : cases_) text += "    " + keys + ") " + body + " ;;\n";
    return text + "  esac\n";
  }

 private:
  std::vector<std::pair<std::string, std::string>> cases_;
};

std::string in_quotes(const std::string& text) { return "'" + text + "'"; }

std::string values_of(const Flag& flag) {
  std::string text = "values=" + (flag.value_count == kAnyNumber ? "any" : std::to_string(flag.value_count));
  if (!flag.words.empty()) text += " words=" + in_quotes(join(flag.words, " "));
  if (flag.is_file) text += " files=" + in_quotes(flag.extensions.empty() ? "any" : join(flag.extensions, " "));
  return text;
}

void add_command(const Command& command, const std::string& name, Cases& known, Cases& taken) {
  std::vector<std::string> flags, commands;
  for (const Flag& flag : command.flags) {
    for (const std::string& each : flag.names) {
      flags.push_back(each);
      if (flag.value_count > 0) taken.add(name + " " + each, values_of(flag));
    }
  }
  for (const Command& each : command.commands) commands.push_back(each.name);
  known.add(name, "flags=" + in_quotes(join(flags, " ")) +
                      (command.passes_on  ? " words='(its own)'"
                       : commands.empty() ? ""
                                          : " words=" + in_quotes(join(commands, " "))));
  size_t place = 0;
  for (const Flag& argument : command.arguments) {
    if (argument.value_count == kAnyNumber) {
      taken.add_pattern("'" + name + " '[0-9]*", values_of(argument));
      break;
    }
    for (size_t i = 0; i < argument.value_count; ++i) {
      taken.add(name + " " + std::to_string(place++), values_of(argument));
    }
  }
}

}  // namespace

std::string bash_completions(const Command& program) {
  Cases known, taken;
  add_command(program, "", known, taken);
  for (const Command& command : program.commands) add_command(command, command.name, known, taken);
  return std::string(kHead) +
         "# The flags of a command, and of the program its commands.\n"
         "_lanewise_knows() {\n" +
         known.text() +
         "}\n\n"
         "# How many values follow a command's flag, or the argument at a place, and what they are.\n"
         "_lanewise_takes() {\n"
         "  values=0 words= files=\n" +
         taken.text() + "}\n" + kSearch;
}

}  // namespace lanewise
