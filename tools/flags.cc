#include "tools/flags.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <sstream>
#include <string_view>

namespace lanewise {
namespace {

template <class T>
bool parse(const std::string& text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

// A validator without a description of its own: --help shows the flag's type name instead.
CLI::Validator validator(std::function<std::string(const std::string&)> complaint) {
  return CLI::Validator([complaint = std::move(complaint)](std::string& text) { return complaint(text); }, "");
}

}  // namespace

CLI::Validator whole_number(uint64_t lo, uint64_t hi, uint64_t step) {
  return validator([=](const std::string& text) {
    uint64_t value = 0;
    if (parse(text, value) && value >= lo && value <= hi && value % step == 0) return std::string();
    return "'" + text + "' is not a " + (step == 1 ? "whole number" : "multiple of " + std::to_string(step)) +
           " from " + std::to_string(lo) + " to " + std::to_string(hi);
  });
}

CLI::Validator real_number(double lo, double hi) {
  return validator([=](const std::string& text) {
    double value = 0;
    if (parse(text, value) && std::isfinite(value) && (lo == 0 ? value > 0 : value >= lo) && value <= hi) {
      return std::string();
    }
    std::ostringstream complaint;
    complaint << "'" << text << "' is not a number ";
    if (lo == 0) {
      complaint << "above 0 and up to " << hi;
    } else {
      complaint << "from " << lo << " to " << hi;
    }
    return complaint.str();
  });
}

std::optional<double> parse_duration(const std::string& text) {
  constexpr std::pair<std::string_view, double> kUnits[] = {{"h", 3600}, {"m", 60}, {"s", 1}, {"ms", 1e-3}};
  double number = 0, seconds = 0;
  if (parse(text, number)) {
    seconds = number;
  } else {
    const auto* unit = std::begin(kUnits);
    for (const char *at = text.data(), *const end = at + text.size(); at != end;) {
      double value = 0;
      const auto [name, error] = std::from_chars(at, end, value, std::chars_format::fixed);
      at = std::find_if(name, end, [](char c) { return c < 'a' || c > 'z'; });
      const std::string_view given(name, static_cast<size_t>(at - name));
      unit = std::find_if(unit, std::end(kUnits), [&](const auto& u) { return u.first == given; });
      if (error != std::errc() || value < 0 || unit == std::end(kUnits)) return {};
      seconds += value * unit++->second;
    }
  }
  if (!std::isfinite(seconds) || seconds <= 0) return {};
  return seconds;
}

CLI::Validator duration() {
  return validator([](const std::string& text) {
    return parse_duration(text) ? std::string() : "'" + text + "' is not a time such as 10s, 90, 2m, 1m30s or 500ms";
  });
}

std::optional<uint64_t> parse_bytes(const std::string& text) {
  constexpr std::pair<std::string_view, double> kUnits[] = {
      {"", 1}, {"K", 0x1p10}, {"M", 0x1p20}, {"G", 0x1p30}, {"T", 0x1p40}};
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [name, error] = std::from_chars(text.data(), end, number, std::chars_format::fixed);
  const std::string_view given(name, static_cast<size_t>(end - name));
  const auto* unit =
      std::find_if(std::begin(kUnits), std::end(kUnits), [&](const auto& u) { return u.first == given; });
  if (error != std::errc() || unit == std::end(kUnits)) return {};
  const double value = number * unit->second;
  if (!(value >= 1 && value < 0x1p62)) return {};
  return static_cast<uint64_t>(value);
}

CLI::Validator bytes() {
  return validator([](const std::string& text) {
    return parse_bytes(text) ? std::string() : "'" + text + "' is not an amount of memory such as 500M, 2G or 1.5G";
  });
}

std::optional<SampleRange> parse_sample_range(const std::string& text) {
  SampleRange range;
  const char* const end = text.data() + text.size();
  const auto [colon, first_error] = std::from_chars(text.data(), end, range.begin);
  if (first_error != std::errc() || colon == end || *colon != ':') return {};
  const auto [rest, last_error] = std::from_chars(colon + 1, end, range.end);
  if (last_error != std::errc() || rest != end || range.begin >= range.end || range.end > kMaxSpp) return {};
  return range;
}

CLI::Validator sample_range() {
  return validator([](const std::string& text) {
    return parse_sample_range(text)
               ? std::string()
               : "'" + text + "' is no range of samples such as 0:64 (the first and one past the last)";
  });
}

CLI::Validator one_of(const std::vector<std::string>& names) {
  return validator([names](const std::string& text) {
    if (std::find(names.begin(), names.end(), text) != names.end()) return std::string();
    return "'" + text + "' is none of " + join_names(names);
  });
}

std::string join_names(const std::vector<std::string>& names) {
  std::string joined;
  for (const std::string& name : names) joined += (joined.empty() ? "" : "|") + name;
  return joined;
}

HelpFormatter::HelpFormatter() {
  column_width(38);
  label("Positionals", "Arguments");
  label("SUBCOMMAND", "COMMAND");
}

std::string HelpFormatter::make_group(std::string group, bool is_positional,
                                      std::vector<const CLI::Option*> options) const {
  const std::string text = CLI::Formatter::make_group(group, is_positional, options);
  // A blank line already follows every group of flags but the last.
  return is_positional || group == "Options" ? text : text.substr(1);
}

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  return option->get_type_size() == 0 ? "" : " " + option->get_type_name();
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
  const std::string initial = option->get_default_str();
  return option->get_description() + (initial.empty() ? "" : " [" + initial + "]");
}

std::string quoted_command_line(int argc, const char* const* argv) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./=:,+@%";
  std::string line = "lanewise";
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string_view::npos) {
      line.append(" ").append(argument);
      continue;
    }
    line += " '";
    for (const char c : argument) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += "'";
  }
  return line;
}

}  // namespace lanewise
