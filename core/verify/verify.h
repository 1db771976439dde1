// Holds the kernels against their twins in double precision, on every target that this machine runs.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/isa.h"
#include "core/render_control.h"
#include "core/verify/oracle.h"

namespace lanewise::verify {

struct VerifyOptions {
  std::vector<std::string> targets = supported_isas();
  uint32_t paths = 1 << 15;  // per kernel and target
  uint32_t seed = 0;
  uint32_t threads = 1;
};

// One kernel on one target. Of those that move, sum or count paths the only field is what they do, and the error is the
// number of things wrong; of those by which paths are used again it is that of core/verify/squares.h.
struct KernelResult {
  const char* name;
  std::string target;
  Tally tally;
};

// Paths are spread over every plan with all settings, and hard on purpose. Kernel after kernel, each on the targets as given; the chosen target is restored.
std::vector<KernelResult> verify_kernels(const VerifyOptions& options,
                                         const std::function<void(const Progress&)>& progress = nullptr);

}  // namespace lanewise::verify
