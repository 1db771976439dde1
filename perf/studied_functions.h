// The functions that kernels are made of, and the ways to compute each: what perf/functions_bench.cc measures.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace lanewise {

// y[i] = f(x[i]) for i < n, a multiple of kLanes.
using ArrayFunction = std::function<void(const float* x, float* y, size_t n)>;

// One way to compute a function; empty where there is none.
struct FunctionVariant {
  std::string name;
  ArrayFunction vectors;              // on the target chosen at the moment
  ArrayFunction in_float, in_double;  // one by one, in scalar code; the second rounds its results to float
};

struct FunctionDomain {
  std::string inputs;        // what x is
  float lo, hi;              // errors are those on floats in [lo, hi]
  float hard;                // where they are largest, if anywhere
  float timed_lo, timed_hi;  // time is that of uniform inputs in [timed_lo, timed_hi)
};

struct StudiedFunction {
  std::string name;  // as a chart has it
  FunctionDomain domain;
  std::function<double(double)> exact;  // good to some 1e-15
  std::vector<FunctionVariant> variants;
};

std::vector<StudiedFunction> studied_functions();

}  // namespace lanewise
