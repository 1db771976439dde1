// What the flags of all commands share: checks of values with one way to say what is wrong, and the look of --help.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/film_file.h"

namespace lanewise {

// A whole number in [lo, hi]; step: it must also be a multiple of that.
CLI::Validator whole_number(uint64_t lo, uint64_t hi, uint64_t step = 1);

// A finite number in [lo, hi], or in (0, hi] for lo = 0.
CLI::Validator real_number(double lo, double hi);

// A span of time: "90" (seconds), "10s", "500ms", "2m", "1h1m30s". Seconds; nothing if it is none, or not above 0.
std::optional<double> parse_duration(const std::string& text);
CLI::Validator duration();

// A number of bytes: "500M", "2G", "1.5G", "800K" (of 1024 each), or the number alone. Nothing if it is none, or not above 0.
std::optional<uint64_t> parse_bytes(const std::string& text);
CLI::Validator bytes();

// "A:B" with A < B, at most kMaxSpp.
std::optional<SampleRange> parse_sample_range(const std::string& text);
CLI::Validator sample_range();

// One of the names.
CLI::Validator one_of(const std::vector<std::string>& names);

// "a|b|c".
std::string join_names(const std::vector<std::string>& names);

// A flag whose value is one of a few names, each for a value of T; its default is what `value` holds.
template <class T>
CLI::Option* add_choice(CLI::App& app, const std::string& flag, T& value,
                        const std::vector<std::pair<std::string, T>>& choices, const std::string& help) {
  std::vector<std::string> names;
  std::string initial;
  for (const auto& [name, choice] : choices) {
    names.push_back(name);
    if (choice == value) initial = name;
  }
  const auto choose = [&value, choices](const std::string& given) {
    for (const auto& [name, choice] : choices) {
      if (name == given) value = choice;
    }
  };
  return app.add_option_function<std::string>(flag, choose, help)
      ->check(one_of(names))
      ->type_name(join_names(names))
      ->default_str(initial);
}

// Help with one line a flag, its default at the end in brackets.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter();
  std::string make_group(std::string group, bool is_positional, std::vector<const CLI::Option*> options) const override;
  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_option_desc(const CLI::Option* option) const override;
};

// The arguments as a shell would need them typed: quoted where they must be.
std::string quoted_command_line(int argc, const char* const* argv);

}  // namespace lanewise
