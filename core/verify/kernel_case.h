// Every kernel that computes a path's fields, with its twin in double precision, its bounds, and paths to try it on.
#pragma once

#include <random>
#include <span>
#include <string>

#include "core/path_state.h"
#include "core/plan.h"
#include "kernels/kernels.h"

namespace lanewise::verify {

struct KernelCase {
  const char* name;
  Kernel* kernel;
  void (*twin)(const Plan&, Path<double>&);
  const KernelBounds& bounds;
  const char* inputs;  // the float fields that it reads, as FieldBound names them, with blanks between: "o d"
  // Makes a path that the kernel may meet, often one at which it is easily wrong. p.slot and p.step are set before.
  void (*fill)(const Plan& plan, std::mt19937& rng, Path<float>& p);
};

std::span<const KernelCase> kernel_cases();
const KernelCase& kernel_case(const std::string& name);

}  // namespace lanewise::verify
