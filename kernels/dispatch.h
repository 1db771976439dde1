// The public side of a kernel's .cc, inside #if HWY_ONCE: exports the SIMD body for every target and defines the
// function that kernels.h declares, which runs the best of them.
#pragma once

#include "hwy/highway.h"

#define LANEWISE_KERNEL(SimdName, name)                                                                            \
  HWY_EXPORT(SimdName);                                                                                            \
  void name(const Plan& plan, const PathState& s, Range range) { HWY_DYNAMIC_DISPATCH(SimdName)(plan, s, range); } \
  static_assert(true, "a semicolon follows")
