// <source>: an array of numbers and the accessor that makes vectors of them.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <pugixml.hpp>
#include <unordered_map>
#include <vector>

#include "scenes/collada_document.h"

namespace lanewise::collada {

// A view of an array that an ArrayCache holds.
struct Source {
  const double* values = nullptr;
  size_t stride = 3;
  std::array<size_t, 3> component{};  // where x, y and z are, from a vector's first value
  size_t count = 0;                   // vectors

  glm::dvec3 operator[](size_t i) const {
    const double* v = values + i * stride;
    return {v[component[0]], v[component[1]], v[component[2]]};
  }
};

// Parses each array once, however many sources refer to it. Lives as long as the sources it gave.
class ArrayCache {
 public:
  explicit ArrayCache(const Document& document) : document_(document) {}

  // The source's vectors of three, or of two, of which z is y again. Fails for missing elements, and for counts that
  // disagree with the numbers in the text.
  Source read(pugi::xml_node source, size_t components = 3);

 private:
  const std::vector<double>& array(pugi::xml_node float_array);

  const Document& document_;
  std::unordered_map<size_t, std::vector<double>> arrays_;  // by the element's hash_value, which is its address
};

}  // namespace lanewise::collada
