#include "tools/command_model.h"

#include <algorithm>
#include <regex>

namespace lanewise {
namespace {

void append_matches(const std::string& text, const std::regex& pattern, std::vector<std::string>& words) {
  for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match) {
    const std::string word = match->str(1);
    if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
  }
}

// Choices are names joined by |, as the values' name or within the description; scenes made by code have a name of their own.
std::vector<std::string> words_of(const Flag& flag) {
  static const std::regex joined(R"((?:^|\s)([\w-]+(?:\|[\w-]+)+))"), each(R"(([^|]+))"), made(R"(\b(builtin:\w+))");
  std::vector<std::string> choices, words;
  append_matches(flag.values.find('|') != std::string::npos ? flag.values : flag.description, joined, choices);
  for (const std::string& names : choices) append_matches(names, each, words);
  append_matches(flag.description, made, words);
  return words;
}

// ".png, .exr", "JSON".
std::vector<std::string> extensions_of(const Flag& flag) {
  static const std::regex pointed(R"((?:^|[\s(])\.([a-z][a-z0-9]*)\b)"), ending(R"(^\w+\.([a-z]+)$)"),
      json(R"(\bJSON\b)");
  std::vector<std::string> extensions;
  append_matches(flag.description, pointed, extensions);
  append_matches(flag.values, ending, extensions);
  if (extensions.empty() && std::regex_search(flag.description, json)) extensions.push_back("json");
  return extensions;
}

bool names_file(const Flag& flag) {
  if (flag.is_positional()) return true;
  static const std::regex file(R"((?:FILE|FOLDER|\.[a-z]+)(?:\.\.\.)?$)");
  return std::regex_search(flag.values, file);
}

Flag read_flag(const CLI::Option& option) {
  Flag flag;
  for (const std::string& name : option.get_snames()) flag.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) flag.names.push_back("--" + name);
  flag.label = option.get_name(true);
  flag.description = option.get_description();
  flag.group = option.get_group();
  const int most = option.get_items_expected_max();
  flag.value_count = most >= CLI::detail::expected_max_vector_size ? kAnyNumber : static_cast<size_t>(most);
  if (option.get_type_size() == 0) flag.value_count = 0;
  if (flag.value_count > 0) flag.values = option.get_type_name();
  flag.initial = option.get_default_str();
  flag.required = option.get_required();
  if (flag.value_count == 0) return flag;
  flag.words = words_of(flag);
  flag.is_file = names_file(flag);
  if (flag.is_file) flag.extensions = extensions_of(flag);
  return flag;
}

bool is_shown(const CLI::Option* option) { return !option->get_group().empty(); }

}  // namespace

Command read_command(const CLI::App& app) {
  Command command;
  command.name = app.get_name();
  command.description = app.get_description();
  command.footer = app.get_footer();
  command.passes_on = app.get_prefix_command();
  for (const CLI::Option* option : app.get_options(is_shown)) {
    Flag flag = read_flag(*option);
    if (flag.is_positional()) {
      command.arguments.push_back(std::move(flag));
    } else {
      flag.label.clear();
      command.flags.push_back(std::move(flag));
    }
  }
  for (const CLI::App* each : app.get_subcommands([](const CLI::App* a) { return !a->get_group().empty(); })) {
    command.commands.push_back(read_command(*each));
  }
  return command;
}

std::string join(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

}  // namespace lanewise
