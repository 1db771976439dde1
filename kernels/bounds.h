// How far a kernel's results may be from those of its twin in double precision, which gets the same floats. kernels.h states
// the bounds beside each kernel; core/verify measures them, for `lanewise verify` and for the tests.
#pragma once

#include <cstdint>

namespace lanewise {

// What an error is counted in.
enum class Unit : uint8_t {
  kExact,     // the twin's value, rounded to float, to the bit
  kUlp,       // of a number: the spacing of floats at the twin's value; of a vector: 2^-23 of the twin's length
  kReachUlp,  // of a point or the difference of two: 2^-23 of the largest coordinate of the plan and of o
  // An ulp as above, and added to it what the twin's value changes by when the kernel's inputs move by one ulp each: a point
  // by one reach ulp along each axis, another vector by 2^-23 of its length along each axis, a number by its ulp. For values
  // that hang on the last bits of what the kernel is given: no arithmetic in float could know them better.
  kInputUlp,
  kInverseInputUlp,  // the same of the value's inverse; that of 0 is 0
};

// field: a name of LANEWISE_PATH_FIELDS without its _x or _r. o d n s l are measured as vectors, beta L c channel by channel.
// max: the most units that any path may be off, on any target. negligible: an absolute error up to this counts as
// none.
struct FieldBound {
  const char* field = nullptr;
  Unit unit = Unit::kExact;
  double max = 0;
  double negligible = 0;
};

constexpr FieldBound exact(const char* field) { return {field, Unit::kExact, 0}; }
constexpr FieldBound ulps(const char* field, double max) { return {field, Unit::kUlp, max}; }
constexpr FieldBound reach_ulps(const char* field, double max) { return {field, Unit::kReachUlp, max}; }
constexpr FieldBound input_ulps(const char* field, double max, double negligible = 0) {
  return {field, Unit::kInputUlp, max, negligible};
}
constexpr FieldBound inverse_input_ulps(const char* field, double max) { return {field, Unit::kInverseInputUlp, max}; }

// A choice (hit or miss, reflect or refract, front or back) may differ from the twin's where the twin, too, makes it for
// inputs moved by at most `margin` ulps each; all fields must then be within their bounds of what the twin gives there.
// max_share: of the paths that `lanewise verify` makes, many of which sit on such an edge on purpose.
struct ChoiceBound {
  double margin = 0;  // 0: the kernel has no choice, or makes it as the twin does
  double max_share = 0;
  const char* decisive = nullptr;  // of the fields only this one is then compared; null: all
};

// What is not listed keeps its bits.
struct KernelBounds {
  static constexpr int kMost = 8;
  FieldBound fields[kMost];  // those without a name are unused
  ChoiceBound choice{};
};

}  // namespace lanewise
