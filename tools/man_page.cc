#include "tools/man_page.h"

#include <algorithm>
#include <sstream>

#include "tools/version.h"

namespace lanewise {
namespace {

constexpr size_t kWorthNaming = 5;  // so many flags that are another command's, too, are named and not told again

// As the pages of the program itself say it: what no flag does.
constexpr const char* kEnd = R"(.SH EXIT STATUS
.TP
.B 0
All went well. \fBlanewise compare\fR ends so whatever the difference is.
.TP
.B 1
A file could not be read or written, the machine lacks something, or \fBlanewise verify\fR found a bound that does not hold.
.TP
.B 2
The command line is wrong.
.PP
A render that SIGINT or SIGTERM stops ends by that signal, once its picture and its checkpoint are written.
.PP
What went wrong is told in one line on the standard error. A picture is written beside its name and renamed, so that an old
one is never half overwritten.
.SH FILES
.TP
.I share/lanewise/scenes
Scenes to begin with, beside the folder of the program, which is in
.IR bin .
.TP
.I share/lanewise/perf
The scripts of \fBchart\fR and \fBreplay\fR, which need Python 3 with matplotlib, NumPy and Pillow.
.TP
.I \(ti/.cache/lanewise
What \fBchart\fR and \fBreplay\fR have rendered; in \fBXDG_CACHE_HOME\fR where that is set.
.SH SEE ALSO
\fBlanewise chart \-\-help\fR and \fBlanewise replay \-\-help\fR tell of those two commands' flags.
.PP
.BR exrheader (1)
shows the command line with which a picture in OpenEXR was made.
)";

// Text that groff shows as it is: - as in command lines, and no character that it would make typographic.
std::string escaped(const std::string& text) {
  std::string escaped;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) escaped += "\\&";
    line_begins = c == '\n';
    switch (c) {
      case '\\':
        escaped += "\\e";
        break;
      case '-':
        escaped += "\\-";
        break;
      case '\'':
        escaped += "\\(aq";
        break;
      case '`':
        escaped += "\\(ga";
        break;
      case '^':
        escaped += "\\(ha";
        break;
      case '~':
        escaped += "\\(ti";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string bold(const std::string& text) { return "\\fB" + escaped(text) + "\\fR"; }
std::string italic(const std::string& text) { return text.empty() ? "" : "\\fI" + escaped(text) + "\\fR"; }

std::string heading(const Flag& flag) {
  if (flag.is_positional()) return italic(flag.label);
  std::string text;
  for (const std::string& name : flag.names) text += (text.empty() ? "" : ", ") + bold(name);
  if (flag.value_count == 0) return text;
  return text + " " + italic(flag.values) + (flag.value_count == kAnyNumber ? " ..." : "");
}

std::string entry(const Flag& flag) {
  std::string text = ".TP\n" + heading(flag) + "\n" + escaped(flag.description) + ".";
  if (!flag.initial.empty()) text += " Default: " + escaped(flag.initial) + ".";
  return text + "\n";
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

bool begins_examples(const std::string& line) { return line == "Examples:"; }

// What a footer says before its examples. Its lines are broken for a terminal: here they are filled, and those that are
// indented, a word and what it means, are a list.
std::string remarks(const std::string& footer) {
  std::string text, last;
  for (const std::string& line : lines_of(footer)) {
    if (begins_examples(line)) break;
    const size_t word = line.find_first_not_of(' ');
    if (word == std::string::npos) {
      text += ".PP\n";
    } else if (word == 0) {
      if (last.starts_with(' ')) text += ".PP\n";
      text += (text.empty() ? ".PP\n" : "") + escaped(line) + "\n";
    } else {
      const size_t gap = std::min(line.find("  ", word), line.size());
      const size_t meaning = std::min(line.find_first_not_of(' ', gap), line.size());
      text += ".TP\n" + bold(line.substr(word, gap - word)) + "\n" + escaped(line.substr(meaning)) + "\n";
    }
    last = line;
  }
  while (text.ends_with(".PP\n")) text.resize(text.size() - 4);
  return text;
}

// "  lanewise render box.dae    what it does".
std::string examples(const std::string& footer) {
  std::string text;
  bool begun = false;
  for (const std::string& line : lines_of(footer)) {
    begun = begun || begins_examples(line);
    const size_t command = line.find_first_not_of(' ');
    if (!begun || command == 0 || command == std::string::npos) continue;
    const size_t gap = std::min(line.find("  ", command), line.size());
    const size_t meaning = std::min(line.find_first_not_of(' ', gap), line.size());
    text += ".TP\n" + bold(line.substr(command, gap - command)) + "\n" +
            (meaning < line.size() ? escaped(line.substr(meaning)) : "\\&") + "\n";
  }
  return text;
}

std::vector<std::string> groups_of(const std::vector<const Flag*>& flags) {
  std::vector<std::string> groups;
  for (const Flag* flag : flags) {
    if (std::find(groups.begin(), groups.end(), flag->group) == groups.end()) groups.push_back(flag->group);
  }
  return groups;
}

bool has(const Command& command, const Flag& flag) {
  return std::find(command.flags.begin(), command.flags.end(), flag) != command.flags.end();
}

// The command before `command` that has most of its flags, if those are many.
const Command* model_of(const Command& program, const Command& command) {
  const Command* model = nullptr;
  auto most = static_cast<std::ptrdiff_t>(kWorthNaming) - 1;
  for (const Command& other : program.commands) {
    if (&other == &command) break;
    const auto shared = std::count_if(command.flags.begin(), command.flags.end(),
                                      [&](const Flag& flag) { return !has(program, flag) && has(other, flag); });
    if (shared > most) {
      most = shared;
      model = &other;
    }
  }
  return model;
}

std::string synopsis(const Command& command) {
  std::string text = bold("lanewise " + command.name);
  if (command.passes_on) return text + " [" + italic("arguments") + "]";
  if (!command.flags.empty()) text += " [" + italic("flags") + "]";
  for (const Flag& argument : command.arguments) {
    const std::string label = italic(argument.label) + (argument.value_count == kAnyNumber ? " ..." : "");
    text += " " + (argument.required ? label : "[" + label + "]");
  }
  return text;
}

std::string section(const Command& program, const Command& command) {
  std::string text = ".SS " + bold("lanewise " + command.name) + "\n" + synopsis(command) + "\n.PP\n" +
                     escaped(command.description) + ".\n";
  if (command.passes_on) return text + bold("lanewise " + command.name + " --help") + "\ntells more.\n";
  text += remarks(command.footer);

  const Command* model = model_of(program, command);
  std::vector<const Flag*> own;
  std::vector<std::string> shared;
  for (const Flag& flag : command.flags) {
    if (has(program, flag)) continue;
    if (model != nullptr && has(*model, flag)) {
      shared.push_back(bold(flag.names.front()));
    } else {
      own.push_back(&flag);
    }
  }
  for (const Flag& argument : command.arguments) text += entry(argument);
  for (const std::string& group : groups_of(own)) {
    if (group != "Options") text += ".PP\n" + bold(group) + "\n";
    for (const Flag* flag : own) {
      if (flag->group == group) text += entry(*flag);
    }
  }
  if (model != nullptr) {
    text += ".PP\nAs for " + bold("lanewise " + model->name) + ":\n" + join(shared, ", ") + ".\n";
  }
  return text;
}

}  // namespace

std::string man_page(const Command& program) {
  const std::string title = program.description;  // "Lanewise, a wavefront path tracer for the CPU"
  std::string text = ".\\\" Made by `lanewise generate man`.\n.TH LANEWISE 1 \"\" \"lanewise " + std::string(kVersion) +
                     "\" \"User Commands\"\n.nh\n.ad l\n.SH NAME\nlanewise \\- " +
                     escaped(title.substr(title.find(", ") + 2)) + "\n.SH SYNOPSIS\n";
  for (const Command& command : program.commands) {
    text += (text.ends_with("SYNOPSIS\n") ? "" : ".br\n") + synopsis(command) + "\n";
  }
  text += ".SH DESCRIPTION\n" + escaped(title) + ". Flags may stand before or after a command\\(aqs arguments.\n" +
          ".SH OPTIONS\n";
  for (const Flag& flag : program.flags) text += entry(flag);
  text += ".SH COMMANDS\n";
  for (const Command& command : program.commands) text += section(program, command);
  text += ".SH EXAMPLES\n";
  for (const Command& command : program.commands) text += examples(command.footer);
  return text + kEnd;
}

}  // namespace lanewise
