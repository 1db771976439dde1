// Which fields of a path a kernel touches: kernels.h states them beside each declaration, tests/kernel_fields_test.cc holds
// the kernels to it, and `lanewise profile` counts from it the bytes that a stage moves.
#pragma once

#include <cstdint>
#include <string_view>

#include "core/path_state.h"

namespace lanewise {

// Names of LANEWISE_PATH_FIELDS with blanks between; "o" stands for o_x o_y o_z, "L" for L_r L_g L_b, and so on; "KEPT" for all
// KEPT fields. Besides them: "result" (of PathState: r, g, b), "kept" (of PathState: all of it), and what all paths share: "step", "batch".
struct KernelFields {
  std::string_view reads;
  std::string_view writes;
};

namespace fields_internal {

// Whether the field is the name itself or, as o_x and L_r, one of the three that it stands for.
constexpr bool is_part(std::string_view field, std::string_view name) {
  if (field == name) return true;
  return field.size() == name.size() + 2 && field.starts_with(name) && field[name.size()] == '_' &&
         std::string_view("xyzrgb").find(field.back()) != std::string_view::npos;
}

constexpr uint32_t count_words(std::string_view name) {
  if (name == "step" || name == "batch") return 0;
  if (name == "result") return 3;
  if (name == "kept") return kKeptFields;
  uint32_t words = 0;
#define LANEWISE_COUNT_KEPT(type, field, meaning) words += name == "KEPT" || is_part(#field, name);
#define LANEWISE_COUNT_LOCAL(type, field, meaning) words += is_part(#field, name);
  LANEWISE_PATH_FIELDS(LANEWISE_COUNT_KEPT, LANEWISE_COUNT_LOCAL)
#undef LANEWISE_COUNT_LOCAL
#undef LANEWISE_COUNT_KEPT
  if (words == 0) throw "no such field";  // in a constant expression: does not compile
  return words;
}

}  // namespace fields_internal

// Calls f(name) for each of the names.
template <class F>
constexpr void for_each_name(std::string_view names, F f) {
  while (!names.empty()) {
    const size_t end = names.find(' ');
    f(names.substr(0, end));
    names = end == std::string_view::npos ? "" : names.substr(end + 1);
  }
}

// Floats and integers, 4 bytes each, that the names stand for.
constexpr uint32_t words(std::string_view names) {
  uint32_t sum = 0;
  for_each_name(names, [&](std::string_view name) { sum += fields_internal::count_words(name); });
  return sum;
}

}  // namespace lanewise
