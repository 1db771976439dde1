// A COLLADA file as a tree of elements: references, numbers, and errors that say where.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "scenes/quoted.h"

namespace lanewise::collada {

class Document {
 public:
  // Both arguments must outlive the document. Throws Error for anything but well-formed XML with the root <COLLADA>,
  // and for entity declarations, which no COLLADA file needs.
  Document(const std::string& path, const std::string& text);

  pugi::xml_node root() const { return root_; }

  // Throws Error "PATH:LINE: <tag> in <ancestor id>: message", on one line.
  [[noreturn]] void fail(pugi::xml_node at, const std::string& message) const;

  // The element of this kind with this id; null if there is none.
  pugi::xml_node by_id(std::string_view id, const char* kind) const;
  // The element of this kind that the attribute, "#id", refers to. Fails if it is missing or leads nowhere.
  pugi::xml_node refer(pugi::xml_node from, const char* attribute, const char* kind) const;

  // The numbers that the element's text lists. Fail for words, NaN, Inf and values beyond double's range; indices also
  // for signs, fractions and values above 2^32 - 1.
  std::vector<double> numbers(pugi::xml_node node) const;
  std::vector<uint32_t> indices(pugi::xml_node node) const;

  // The same, of a given length.
  std::vector<double> numbers(pugi::xml_node node, size_t count) const;
  double number(pugi::xml_node node) const { return numbers(node, 1)[0]; }
  // Three numbers; a fourth, alpha, may follow and is left out.
  glm::dvec3 color(pugi::xml_node node) const;

  // The number in an attribute; none if the element has no such attribute. A count is whole.
  std::optional<uint64_t> count(pugi::xml_node node, const char* attribute) const;
  std::optional<double> attribute_number(pugi::xml_node node, const char* attribute) const;

 private:
  // offset: where in the text the line is.
  [[noreturn]] void fail(pugi::xml_node at, const std::string& message, ptrdiff_t offset) const;
  [[noreturn]] void fail_token(pugi::xml_node text_node, const char* token, const char* what) const;
  // Calls parse(text node, begin, end of text) for each token; it returns where the token ends.
  template <class Parse>
  void for_each_token(pugi::xml_node node, Parse parse) const;

  const std::string& path_;
  const std::string& text_;
  pugi::xml_document xml_;
  pugi::xml_node root_;
  std::unordered_map<std::string, pugi::xml_node> ids_;
};

// "name" or else "id", for display: at most its first 256 bytes.
std::string name_of(pugi::xml_node node);

// The <technique profile="CGL"> of the element's <extra>; null if there is none.
pugi::xml_node cgl_technique(pugi::xml_node node);

}  // namespace lanewise::collada
