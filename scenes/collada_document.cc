#include "scenes/collada_document.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/types.h"

namespace lanewise::collada {
namespace {

constexpr bool is_space(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

// pugixml leaves entities that it does not know as they are, so none expands; a file that declares some is refused all
// the same, since its text would not mean what it says.
void refuse_entities(const Document& document, pugi::xml_node xml) {
  for (const pugi::xml_node node : xml.children()) {
    if (node.type() == pugi::node_doctype && std::strstr(node.value(), "<!ENTITY") != nullptr) {
      document.fail(node, "entity declarations are not accepted");
    }
  }
}

// Past the element's subtree, or into it, in document order; null at the end. A loop, so that no depth can exhaust the
// stack.
pugi::xml_node next_element(pugi::xml_node node, pugi::xml_node root) {
  if (const pugi::xml_node child = node.first_child()) return child;
  while (node != root) {
    if (const pugi::xml_node sibling = node.next_sibling()) return sibling;
    node = node.parent();
  }
  return {};
}

// Kinds have ids of their own, since some exporters give a material and its effect the same one.
std::string key(const char* kind, std::string_view id) { return std::string(kind) + '#' + std::string(id); }

bool looks_like_html(std::string_view text) {
  std::string start(text.substr(0, 512));
  std::ranges::transform(start, start.begin(), [](unsigned char c) { return std::tolower(c); });
  return start.find("<html") != std::string::npos || start.find("<!doctype html") != std::string::npos;
}

constexpr size_t kLongestName = 256;  // whatever is instanced has a copy

enum class NumberError { kNone, kWord, kRange };

// Parses a double at begin. from_chars knows no locale, no leading plus and no underflow.
NumberError parse_double(const char*& begin, const char* end, double& value) {
  const char* start = begin;
  if (*start == '+' && start + 1 != end && start[1] != '-') ++start;
  auto result = std::from_chars(start, end, value);
  if (result.ec == std::errc::result_out_of_range) {
    long double wide = 0;
    result = std::from_chars(start, end, wide);
    if (result.ec != std::errc() || !(std::abs(wide) < 1)) return NumberError::kRange;
    value = 0;
  }
  if (result.ec != std::errc()) return NumberError::kWord;
  begin = result.ptr;
  return std::isfinite(value) ? NumberError::kNone : NumberError::kRange;
}

}  // namespace

std::string name_of(pugi::xml_node node) {
  const char* name = node.attribute("name").value();
  const std::string_view found = *name != '\0' ? name : node.attribute("id").value();
  return std::string(found.substr(0, kLongestName));
}

pugi::xml_node cgl_technique(pugi::xml_node node) {
  for (const pugi::xml_node extra : node.children("extra")) {
    if (const pugi::xml_node found = extra.find_child_by_attribute("technique", "profile", "CGL")) return found;
  }
  return {};
}

Document::Document(const std::string& path, const std::string& text) : path_(path), text_(text) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) throw Error(path + ": is empty, not a COLLADA file");
  if (text.find('\0') != std::string::npos) throw Error(path + ": is not UTF-8 text, so not a COLLADA file");

  constexpr unsigned kFlags = pugi::parse_cdata | pugi::parse_escapes | pugi::parse_doctype;
  const pugi::xml_parse_result result = xml_.load_buffer(text.data(), text.size(), kFlags, pugi::encoding_utf8);
  if (result.status == pugi::status_out_of_memory) throw std::bad_alloc();
  if (!result) {
    const auto offset = std::clamp<ptrdiff_t>(result.offset, 0, static_cast<ptrdiff_t>(text.size()));
    const auto line = 1 + std::count(text.begin(), text.begin() + offset, '\n');
    const std::string at = path + ':' + std::to_string(line) + ": not a COLLADA file: not well-formed XML";
    if (looks_like_html(text)) throw Error(at + " but HTML");
    throw Error(at + ", broken or truncated: " + result.description());
  }
  refuse_entities(*this, xml_);
  root_ = xml_.document_element();
  if (std::strcmp(root_.name(), "COLLADA") != 0) {
    fail(root_, "not a COLLADA file: its root element is " + quoted(root_.name()));
  }
  for (pugi::xml_node node = root_; node; node = next_element(node, root_)) {
    if (const pugi::xml_attribute id = node.attribute("id")) ids_.emplace(key(node.name(), id.value()), node);
  }
}

void Document::fail(pugi::xml_node at, const std::string& message) const { fail(at, message, at.offset_debug()); }

void Document::fail(pugi::xml_node at, const std::string& message, ptrdiff_t offset) const {
  const auto line = 1 + std::count(text_.begin(), text_.begin() + std::max<ptrdiff_t>(offset, 0), '\n');
  std::string where = path_ + ':' + std::to_string(line) + ": ";
  if (at.type() == pugi::node_element) {
    where += '<' + std::string(at.name()) + '>';
    const char* preposition = " ";
    for (pugi::xml_node node = at; node; node = node.parent(), preposition = " in ") {
      if (!node.attribute("id")) continue;
      where += preposition;
      if (node != at) where += std::string(node.name()) + ' ';
      where += quoted(node.attribute("id").value());
      break;
    }
    where += ": ";
  }
  throw Error(where + message);
}

void Document::fail_token(pugi::xml_node text_node, const char* token, const char* what) const {
  size_t length = 0;
  while (token[length] != '\0' && !is_space(token[length])) ++length;
  // The line is the token's own, which in a long array is not its element's.
  fail(text_node.parent(), quoted({token, length}) + what, text_node.offset_debug() + (token - text_node.value()));
}

pugi::xml_node Document::by_id(std::string_view id, const char* kind) const {
  const auto found = ids_.find(key(kind, id));
  return found == ids_.end() ? pugi::xml_node() : found->second;
}

pugi::xml_node Document::refer(pugi::xml_node from, const char* attribute, const char* kind) const {
  const pugi::xml_attribute reference = from.attribute(attribute);
  if (!reference) fail(from, "has no attribute " + std::string(attribute));
  const std::string_view url = reference.value();
  if (!url.starts_with('#')) {
    fail(from, std::string(attribute) + ' ' + quoted(url) + " does not refer into this file: it must begin with #");
  }
  const pugi::xml_node target = by_id(url.substr(1), kind);
  if (!target) fail(from, "refers to " + quoted(url) + ", but no <" + kind + "> has that id");
  return target;
}

template <class Parse>
void Document::for_each_token(pugi::xml_node node, Parse parse) const {
  for (const pugi::xml_node text : node.children()) {
    if (text.type() != pugi::node_pcdata && text.type() != pugi::node_cdata) continue;
    const char* p = text.value();
    const char* end = p + std::strlen(p);
    while (true) {
      while (p != end && is_space(*p)) ++p;
      if (p == end) break;
      p = parse(text, p, end);
    }
  }
}

std::vector<double> Document::numbers(pugi::xml_node node) const {
  std::vector<double> values;
  for_each_token(node, [&](pugi::xml_node text, const char* begin, const char* end) {
    const char* p = begin;
    double value = 0;
    const NumberError error = parse_double(p, end, value);
    if (error == NumberError::kRange) fail_token(text, begin, " is not a finite number within range");
    if (error == NumberError::kWord || (p != end && !is_space(*p))) fail_token(text, begin, " is not a number");
    values.push_back(value);
    return p;
  });
  return values;
}

std::vector<uint32_t> Document::indices(pugi::xml_node node) const {
  std::vector<uint32_t> values;
  for_each_token(node, [&](pugi::xml_node text, const char* begin, const char* end) {
    const char* p = begin;
    uint64_t value = 0;
    while (p != end && *p >= '0' && *p <= '9' && value <= std::numeric_limits<uint32_t>::max()) {
      value = 10 * value + static_cast<uint64_t>(*p++ - '0');
    }
    if (value > std::numeric_limits<uint32_t>::max()) fail_token(text, begin, " is an index out of range");
    if (p == begin || (p != end && !is_space(*p))) fail_token(text, begin, " is not an index");
    values.push_back(static_cast<uint32_t>(value));
    return p;
  });
  return values;
}

std::vector<double> Document::numbers(pugi::xml_node node, size_t count) const {
  std::vector<double> values = numbers(node);
  if (values.size() != count) {
    fail(node, std::to_string(count) + " numbers expected, not " + std::to_string(values.size()));
  }
  return values;
}

glm::dvec3 Document::color(pugi::xml_node node) const {
  const std::vector<double> values = numbers(node);
  if (values.size() != 3 && values.size() != 4) {
    fail(node, "3 numbers (red, green, blue) expected, not " + std::to_string(values.size()));
  }
  return {values[0], values[1], values[2]};
}

std::optional<uint64_t> Document::count(pugi::xml_node node, const char* attribute) const {
  const pugi::xml_attribute text = node.attribute(attribute);
  if (!text) return std::nullopt;
  const char* begin = text.value();
  const char* end = begin + std::strlen(begin);
  uint64_t value = 0;
  const auto [p, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || p != end) {
    fail(node, std::string(attribute) + ' ' + quoted(begin) + " is not a whole number within range");
  }
  return value;
}

std::optional<double> Document::attribute_number(pugi::xml_node node, const char* attribute) const {
  const pugi::xml_attribute text = node.attribute(attribute);
  if (!text) return std::nullopt;
  const char* p = text.value();
  const char* end = p + std::strlen(p);
  double value = 0;
  if (parse_double(p, end, value) != NumberError::kNone || p != end) {
    fail(node, std::string(attribute) + ' ' + quoted(text.value()) + " is not a finite number");
  }
  return value;
}

}  // namespace lanewise::collada
