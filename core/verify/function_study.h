// The errors of the functions of kernels/functions.h against double precision.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/render.h"
#include "kernels/functions.h"

namespace lanewise::verify {

// One function on one target. Errors in ulp: spacings of floats at the exact value.
struct FunctionError {
  const FunctionInfo* function = nullptr;
  std::string target;
  uint64_t inputs = 0;
  double max_error = 0;  // NaN results count as infinite
  double mean_error = 0;
  float worst_input = 0;

  bool within_bound() const { return max_error <= function->max_ulp; }
};

// Every stride-th float of each function's domain; with a stride above 1 also all floats around its ends and around what is
// hard. The exact values are computed once for all targets. stride 1 takes minutes. Function after function, each on the
// targets as given; the chosen target is restored.
std::vector<FunctionError> study_functions(const std::vector<std::string>& targets, uint64_t stride, uint32_t threads,
                                           const std::function<void(const Progress&)>& progress = nullptr);

}  // namespace lanewise::verify
