// The functions of one float of math-inl.h by name, with the domains that the kernels use them on and the largest errors
// there: the one list for studies of their accuracy (core/verify/function_study.h) and of their speed. Besides these,
// kernels use only what IEEE 754 rounds correctly: + - * / sqrt and conversions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace lanewise {

//   X(enumerator, name, lo, hi, hard, max_ulp, what)
// Every float in [lo, hi] is in the domain. max_ulp: the largest error on any target, in spacings of floats at the exact
// value; what the exhaustive study finds, rounded up (perf/results/functions.md). hard: an input beside which the relative
// error is hard to keep, mostly because the function is 0 there.
#define LANEWISE_FUNCTIONS(X)                                                          \
  X(kSin2Pi, sin2pi, 0.0f, 1.0f, 0.5f, 2, "sin(2 pi x)")                               \
  X(kCos2Pi, cos2pi, 0.0f, 1.0f, 0.25f, 2, "cos(2 pi x)")                              \
  X(kAtanTurns, atan_turns, -0.41421366f, 0.41421366f, 0.0f, 2.25, "atan(x) / (2 pi)") \
  X(kExp, exp, -std::numeric_limits<float>::infinity(), 88.0f, -87.3365f, 1.25,        \
    "e^x; 0 below -87.3365, where e^x is 2^-126")                                      \
  X(kLog, log, 0x1p-126f, 0x1.fffffep+127f, 1.0f, 1, "ln x")                           \
  X(kErfcx, erfcx, 0.0f, 10.0f, 0.0f, 8, "e^(x^2) erfc(x)")                            \
  X(kErfInvCentered, erf_inv_centered, 0x1p-25f, 0x1.fffffep-1f, 0.5f, 5, "erf^-1(2 x - 1)")

enum class Function : uint8_t {
#define LANEWISE_ENUMERATOR(enumerator, name, lo, hi, hard, max_ulp, what) enumerator,
  LANEWISE_FUNCTIONS(LANEWISE_ENUMERATOR)
#undef LANEWISE_ENUMERATOR
};

struct FunctionInfo {
  Function function;
  const char* name;
  float lo, hi, hard;
  double max_ulp;
  const char* what;
};

inline constexpr FunctionInfo kFunctions[] = {
#define LANEWISE_INFO(enumerator, name, lo, hi, hard, max_ulp, what) \
  {Function::enumerator, #name, lo, hi, hard, max_ulp, what},
    LANEWISE_FUNCTIONS(LANEWISE_INFO)
#undef LANEWISE_INFO
};

// y[i] = f(x[i]) for i < n, a multiple of kLanes, on the target chosen at the moment; x and y may be the same.
void apply_function(Function f, const float* x, float* y, size_t n);

// turns[i] = atan2(y[i], x[i]) / (2 pi), in the same way.
void apply_atan2_turns(const float* y, const float* x, float* turns, size_t n);

}  // namespace lanewise
