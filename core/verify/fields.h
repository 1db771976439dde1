// A path's fields as plain numbers by index, for code that treats them all alike.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include "core/path_state.h"

namespace lanewise::verify {

struct FieldInfo {
  const char* name;
  bool is_float;
};

inline constexpr FieldInfo kFields[] = {
#define LANEWISE_INFO(type, name, meaning) {#name, std::is_same_v<type, float>},
    LANEWISE_PATH_FIELDS(LANEWISE_INFO, LANEWISE_INFO)
#undef LANEWISE_INFO
};
constexpr size_t kFieldCount = std::size(kFields);

using FieldValues = std::array<double, kFieldCount>;

template <class T>
FieldValues values_of(const Path<T>& p) {
  return {
#define LANEWISE_VALUE(type, name, meaning) static_cast<double>(p.name),
      LANEWISE_PATH_FIELDS(LANEWISE_VALUE, LANEWISE_VALUE)
#undef LANEWISE_VALUE
  };
}

// Back to a path; rounds for float.
template <class T>
Path<T> path_of(const FieldValues& values, const Step& step) {
  Path<T> p;
  size_t i = 0;
#define LANEWISE_SET(type, name, meaning) p.name = static_cast<decltype(p.name)>(values[i++]);
  LANEWISE_PATH_FIELDS(LANEWISE_SET, LANEWISE_SET)
#undef LANEWISE_SET
  p.step = step;
  return p;
}

template <class To, class From>
Path<To> convert_path(const Path<From>& p) {
  return path_of<To>(values_of(p), p.step);
}

}  // namespace lanewise::verify
