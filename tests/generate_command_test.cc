// The completions and the man page that the program makes of its own command line, against what its --help tells.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/program.h"
#include "tests/subprocess.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

using test::nothing_to_test;
using test::ProcessResult;
using test::program;
using test::TemporaryFolder;
using Arguments = std::vector<std::string>;
using Names = std::set<std::string>;

constexpr const char* kNone = "";  // in place of a command: the program's own flags

std::string said(const TemporaryFolder& folder, const Arguments& arguments) {
  const ProcessResult result = test::run_process(program(), arguments, folder.path());
  CAPTURE(result.err);
  REQUIRE(result.exit_code == 0);
  return result.out;
}

Names lines_of(const std::string& text) {
  std::istringstream stream(text);
  Names lines;
  for (std::string line; std::getline(stream, line);) lines.insert(line);
  return lines;
}

// What --help tells of a command.
struct Help {
  std::map<std::string, std::string> flags;  // by each of their names: what stands for the value
  std::string text;
};

Help help_of(const TemporaryFolder& folder, const std::string& command) {
  Help help;
  help.text = command.empty() ? said(folder, {"--help"}) : said(folder, {command, "--help"});
  const std::regex flag(R"(^  (-[\w,-]+)(?: (\S+))?)");
  for (const std::string& line : lines_of(help.text)) {
    std::smatch match;
    if (!std::regex_search(line, match, flag)) continue;
    std::istringstream names(match[1]);
    for (std::string name; std::getline(names, name, ',');) help.flags[name] = match[2];
  }
  REQUIRE(help.flags.contains("--help"));
  return help;
}

Names flags_of(const Help& help) {
  Names names;
  for (const auto& [name, value] : help.flags) names.insert(name);
  return names;
}

Names commands_of(const TemporaryFolder& folder) {
  const std::string text = said(folder, {"--help"});
  const std::regex command(R"(^  ([a-z]\S*)  )");
  Names names;
  for (const std::string& line : lines_of(text)) {
    std::smatch match;
    if (std::regex_search(line, match, command)) names.insert(match[1]);
  }
  REQUIRE(names.contains("render"));
  return names;
}

// chart and replay hand their arguments on.
bool has_flags(const std::string& command) { return command != "chart" && command != "replay"; }

// What bash completes the last of the words to.
Names completed(const TemporaryFolder& folder, const std::string& words) {
  const std::string script = "source ./completions; COMP_WORDS=(" + words +
                             "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _lanewise; printf '%s\\n' \"${COMPREPLY[@]}\"";
  const ProcessResult result = test::run_process("/bin/bash", {"--norc", "-c", script}, folder.path());
  CAPTURE(words);
  CHECK(result.err.empty());
  Names names = lines_of(result.out);
  names.erase("");
  return names;
}

void write_page(const TemporaryFolder& folder, const std::string& kind, const std::string& name) {
  test::write_text(folder.file(name), said(folder, {"generate", kind}));
}

TEST_CASE("generate command: bash completes every command and flag that --help knows, and no other") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  write_page(folder, "bash", "completions");
  const Names commands = commands_of(folder);
  CHECK(completed(folder, "lanewise ''") == commands);
  CHECK(completed(folder, "lanewise re") == Names{"render", "replay"});
  CHECK(completed(folder, "lanewise -") == flags_of(help_of(folder, kNone)));
  for (const std::string& command : commands) {
    CAPTURE(command);
    if (!has_flags(command)) {
      CHECK(completed(folder, "lanewise " + command + " -").empty());
      continue;
    }
    const Help help = help_of(folder, command);
    CHECK(completed(folder, "lanewise " + command + " -") == flags_of(help));
    for (const auto& [flag, value] : help.flags) {
      if (value.find('|') == std::string::npos) continue;
      CAPTURE(flag);
      Names choices;
      std::istringstream stream(value);
      for (std::string choice; std::getline(stream, choice, '|');) choices.insert(choice);
      CHECK(completed(folder, "lanewise " + command + " " + flag + " ''") == choices);
      CHECK(completed(folder, "lanewise " + command + " " + flag + " = ''") == choices);
    }
  }
}

TEST_CASE("generate command: bash completes values, files by their endings, and nothing where it knows nothing") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  write_page(folder, "bash", "completions");
  for (const char* name : {"a b.dae", "C.OBJ", "d.exr", "e.json", "f.png", "g.txt"}) {
    test::write_text(folder.file(name), "");
  }
  std::filesystem::create_directory(folder.file("sub"));
  const Names scenes = {"a b.dae", "C.OBJ", "sub", "builtin:dense"};
  CHECK(completed(folder, "lanewise render ''") == scenes);
  CHECK(completed(folder, "lanewise render -r 640 480 -q -s 16 ''") == scenes);
  CHECK(completed(folder, "lanewise info ''") == scenes);
  CHECK(completed(folder, "lanewise render 'a\\ b'") == Names{"a b.dae"});
  CHECK(completed(folder, "lanewise render C.OBJ ''").empty());
  CHECK(completed(folder, "lanewise render -s ''").empty());
  CHECK(completed(folder, "lanewise render -r 640 ''").empty());
  CHECK(completed(folder, "lanewise render --see") == Names{"--seed"});
  CHECK(completed(folder, "lanewise render --metal br") == Names{"brass"});
  CHECK(completed(folder, "lanewise render C.OBJ -f ''") == Names{"d.exr", "f.png", "sub"});
  CHECK(completed(folder, "lanewise render -e ''") == Names{"d.exr", "sub"});
  CHECK(completed(folder, "lanewise render -c ''") == Names{"e.json", "sub"});
  CHECK(completed(folder, "lanewise profile ''").contains("e.json"));
  CHECK(completed(folder, "lanewise compare f.png ''") == Names{"d.exr", "f.png", "sub"});
  CHECK(completed(folder, "lanewise plan --json ''").contains("g.txt"));
}

TEST_CASE("generate command: fish completes every command and flag that --help knows") {
  if (nothing_to_test()) return;
  if (!std::filesystem::exists("/usr/bin/fish")) {
    MESSAGE("skipped: no fish");
    return;
  }
  const TemporaryFolder folder;
  write_page(folder, "fish", "completions");
  const auto completes = [&](const std::string& line) {
    const std::string script = "source ./completions; complete -C '" + line + "' | string replace -r '\\t.*' ''";
    const ProcessResult result = test::run_process(
        "/usr/bin/env", {"HOME=" + folder.path().string(), "fish", "--no-config", "-c", script}, folder.path());
    CHECK(result.err.empty());
    return lines_of(result.out);
  };
  const Names commands = commands_of(folder);
  CHECK(completes("lanewise ") == commands);
  for (const std::string& command : commands) {
    if (!has_flags(command)) continue;
    CAPTURE(command);
    CHECK(completes("lanewise " + command + " -") == flags_of(help_of(folder, command)));
  }
  CHECK(completes("lanewise render --reference ") == Names{"float", "double"});
  test::write_text(folder.file("x.DAE"), "");
  CHECK(completes("lanewise info ") == Names{"x.DAE", "builtin:dense"});
}

TEST_CASE("generate command: zsh's completions name every command and flag that --help knows") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  write_page(folder, "zsh", "_lanewise");
  const std::string script = test::read_text(folder.file("_lanewise"));
  for (const std::string& command : commands_of(folder)) {
    CAPTURE(command);
    CHECK(script.find("\n      '" + command + ":") != std::string::npos);
    const size_t begin = script.find("\n_lanewise_" + command + "() {\n");
    REQUIRE(begin != std::string::npos);
    if (!has_flags(command)) continue;
    const std::string function = script.substr(begin, script.find("\n}\n", begin) - begin);
    for (const auto& [flag, value] : help_of(folder, command).flags) {
      CAPTURE(flag);
      const std::regex spec("[{,']" + flag + "[=+]?[},\\[]");
      CHECK(std::regex_search(function, spec));
    }
  }
  if (!std::filesystem::exists("/usr/bin/zsh")) {
    MESSAGE("skipped: no zsh");
    return;
  }
  const ProcessResult read = test::run_process("/usr/bin/zsh", {"-f", "-n", "_lanewise"}, folder.path());
  CHECK(read.err.empty());
  CHECK(read.exit_code == 0);
}

TEST_CASE("generate command: the man page tells of every command and flag, and groff has nothing to warn of") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  write_page(folder, "man", "lanewise.1");
  const std::string page = std::regex_replace(test::read_text(folder.file("lanewise.1")), std::regex(R"(\\-)"), "-");
  for (const char* section :
       {"NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "COMMANDS", "EXAMPLES", "EXIT STATUS", "FILES", "SEE ALSO"}) {
    CAPTURE(section);
    CHECK(page.find("\n.SH " + std::string(section) + "\n") != std::string::npos);
  }
  for (const std::string& command : commands_of(folder)) {
    CAPTURE(command);
    const size_t begin = page.find("\n.SS \\fBlanewise " + command + "\\fR\n");
    REQUIRE(begin != std::string::npos);
    if (!has_flags(command)) continue;
    const std::string told = page.substr(begin, page.find("\n.S", begin + 1) - begin);
    const Help help = help_of(folder, command);
    // Of a flag that a command shares, the first name stands there; all of its names where it is explained.
    const std::regex first(R"(\n  (-[\w-]+)(?:,(--[\w-]+))?)");
    for (std::sregex_iterator flag(help.text.begin(), help.text.end(), first), end; flag != end; ++flag) {
      CAPTURE(flag->str(1));
      CHECK((flag->str(1) == "-h" || told.find("\\fB" + flag->str(1) + "\\fR") != std::string::npos));
      CHECK(page.find("\\fB" + (flag->length(2) > 0 ? flag->str(2) : flag->str(1)) + "\\fR") != std::string::npos);
    }
    const size_t examples = help.text.find("\nExamples:\n");
    if (examples == std::string::npos) continue;
    const std::regex example("\n  (lanewise " + command + ".*?)(?:  .*)?(?=\n|$)");
    std::sregex_iterator line(help.text.begin() + static_cast<std::ptrdiff_t>(examples), help.text.end(), example),
        none;
    CHECK(line != none);
    for (; line != none; ++line) {
      CAPTURE(line->str(1));
      CHECK(page.find("\n.TP\n\\fB" + line->str(1) + "\\fR\n") != std::string::npos);
    }
  }
  if (!std::filesystem::exists("/usr/bin/groff")) {
    MESSAGE("skipped: no groff");
    return;
  }
  const ProcessResult set =
      test::run_process("/usr/bin/groff", {"-man", "-Tutf8", "-ww", "-z", "lanewise.1"}, folder.path());
  CHECK(set.err.empty());
  CHECK(set.exit_code == 0);
}

TEST_CASE("generate command: hidden from --help, and a wrong kind is one line") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  CHECK(!commands_of(folder).contains("generate"));
  const ProcessResult wrong = test::run_process(program(), {"generate", "tcsh"}, folder.path());
  CHECK(wrong.exit_code == 2);
  CHECK(wrong.out.empty());
  CHECK(wrong.err == "lanewise: KIND: 'tcsh' is none of man|bash|zsh|fish\n");
}

}  // namespace
}  // namespace lanewise
