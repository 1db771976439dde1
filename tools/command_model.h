// The command line as data, read off its parser: what completions and the man page are made of.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>
#include <vector>

namespace lanewise {

inline constexpr size_t kAnyNumber = 1000;

// A flag, or an argument by its place, which has a label and no names.
struct Flag {
  std::vector<std::string> names;  // "-s", "--spp"
  std::string label;               // "SCENE"
  std::string description;
  std::string group;
  std::string values;      // as --help has them: "W H", "mis|light"; empty: none, or an argument
  size_t value_count = 0;  // kAnyNumber: as many as there are
  std::string initial;     // the default; empty: none
  bool required = false;

  // What a value may be: one of the words, a file, either, or nothing that is known before it is typed.
  std::vector<std::string> words;
  bool is_file = false;
  std::vector<std::string> extensions;  // that the file has, without the point; empty: any

  bool is_positional() const { return names.empty(); }
  bool operator==(const Flag&) const = default;
};

struct Command {
  std::string name;
  std::string description;
  std::string footer;
  bool passes_on = false;  // every argument is for another program to read
  std::vector<Flag> flags;
  std::vector<Flag> arguments;    // by their places
  std::vector<Command> commands;  // of the program itself
};

// Without what --help hides.
Command read_command(const CLI::App& app);

// "a, b, c", with another separator than ", ".
std::string join(const std::vector<std::string>& words, const std::string& separator);

}  // namespace lanewise
