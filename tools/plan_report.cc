#include "tools/plan_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "tools/text.h"

namespace lanewise {
namespace {

constexpr size_t kWidth = 118;
constexpr size_t kLeastReason = 28;
constexpr size_t kLongestSubject = 28;  // longer ones, names of a scene's meshes, are cut
constexpr const char* kGap = "  ";

std::string text_of(const Figure& figure) {
  switch (figure.unit) {
    case FigureUnit::kBytes:
      return short_count(figure.value) + (figure.value < 999.5 ? " B" : "B");
    case FigureUnit::kShare:
      return print("%.1f %%", 100 * figure.value);
    case FigureUnit::kCount:
      break;
  }
  return print("%.*f", figure.value == std::floor(figure.value) ? 0 : 1, figure.value);
}

// The name's last word, and what stands before it.
struct Heading {
  std::string upper, lower;

  explicit Heading(std::string name) {
    std::ranges::replace(name, '_', ' ');
    const size_t blank = name.rfind(' ');
    upper = blank == std::string::npos ? "" : name.substr(0, blank);
    lower = name.substr(blank + 1);
  }
};

struct Column {
  std::string figure;  // empty: text, aligned to the left
  std::string upper, lower;
  std::vector<std::string> cells;

  size_t width() const {
    size_t most = std::max(upper.size(), lower.size());
    for (const std::string& cell : cells) most = std::max(most, cell.size());
    return most;
  }
  std::string padded(const std::string& cell) const {
    const std::string blanks(width() - cell.size(), ' ');
    return figure.empty() ? cell + blanks : blanks + cell;
  }
};

std::string printable(std::string name) {
  for (char& c : name) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  if (name.size() <= kLongestSubject) return name;
  // Not within a character of several bytes.
  size_t end = kLongestSubject - 3;
  while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0) == 0x80) --end;
  return name.substr(0, end) + "...";
}

std::vector<Column> columns_of(std::span<const Decision> rows) {
  std::vector<Column> columns = {{"", "", rows[0].topic, {}}, {"", "", "choice", {}}};
  for (const Decision& row : rows) {
    columns[0].cells.push_back(printable(row.subject));
    columns[1].cells.push_back(row.choice);
    for (const Figure& figure : row.figures) {
      if (std::ranges::any_of(columns, [&](const Column& c) { return c.figure == figure.name; })) continue;
      const Heading heading(figure.name);
      columns.push_back({figure.name, heading.upper, heading.lower, {}});
    }
  }
  for (Column& column : std::span(columns).subspan(2)) {
    for (const Decision& row : rows) {
      const auto found = std::ranges::find_if(row.figures, [&](const Figure& f) { return column.figure == f.name; });
      column.cells.push_back(found == row.figures.end() ? "" : text_of(*found));
    }
  }
  return columns;
}

// At blanks, into lines of at most `width` characters where words allow it; one line at least.
std::vector<std::string> wrap(const std::string& text, size_t width) {
  std::vector<std::string> lines(1);
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > width) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
    at = end + 1;
  }
  return lines;
}

void append_line(std::string& text, std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  text += line + "\n";
}

std::string topic_table(std::span<const Decision> rows) {
  const std::vector<Column> columns = columns_of(rows);
  std::string upper, lower, text;
  bool two_lines = false;
  for (const Column& column : columns) {
    upper += column.padded(column.upper) + kGap;
    lower += column.padded(column.lower) + kGap;
    two_lines |= !column.upper.empty();
  }
  const size_t indent = lower.size();
  const size_t room = std::max(kLeastReason, kWidth - std::min(kWidth, indent));
  if (two_lines) append_line(text, upper);
  append_line(text, lower + "reason");
  for (size_t i = 0; i < rows.size(); ++i) {
    std::string line;
    for (const Column& column : columns) line += column.padded(column.cells[i]) + kGap;
    for (const std::string& part : wrap(rows[i].reason, room)) {
      append_line(text, line + part);
      line.assign(indent, ' ');
    }
  }
  return text;
}

}  // namespace

nlohmann::ordered_json decisions_json(const std::vector<Decision>& decisions) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Decision& d : decisions) {
    nlohmann::ordered_json figures = nlohmann::ordered_json::object();
    for (const Figure& figure : d.figures) {
      const bool whole = figure.value == std::floor(figure.value);
      if (whole) figures[figure.name] = static_cast<uint64_t>(figure.value);
      if (!whole) figures[figure.name] = figure.value;
    }
    list.push_back(
        {{"topic", d.topic}, {"subject", d.subject}, {"choice", d.choice}, {"reason", d.reason}, {"figures", figures}});
  }
  return list;
}

std::string decisions_table(const std::vector<Decision>& decisions) {
  std::string text;
  for (auto begin = decisions.begin(); begin != decisions.end();) {
    const auto end = std::find_if(begin, decisions.end(), [&](const Decision& d) { return d.topic != begin->topic; });
    text += (text.empty() ? "" : "\n") + topic_table({begin, end});
    begin = end;
  }
  return text;
}

}  // namespace lanewise
