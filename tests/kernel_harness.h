// Runs a kernel against its scalar twin in double precision on every target that this machine can run.
#pragma once

#include <functional>
#include <random>

#include "core/path_buffer.h"
#include "core/plan.h"
#include "core/verify/kernel_case.h"
#include "core/verify/random_path.h"
#include "kernels/kernels.h"
#include "kernels/reference/vec3.h"

namespace lanewise::test {

// Runs the kernel of that name in verify::kernel_cases() on 0 .. 2 * kLanes and 1000 paths on every supported target, with
// doctest checks that name target, field and lane. The paths are the case's own, and changed by `change` if it is given. The
// bounds are those beside the kernel's declaration; fields that are not in them must keep their bits.
void check_kernel(const Plan& plan, const char* kernel, const Step& step = {},
                  const std::function<void(std::mt19937&, Path<float>&)>& change = nullptr);
void check_kernel(const Plan& plan, const verify::KernelCase& kernel, const Step& step = {},
                  const std::function<void(std::mt19937&, Path<float>&)>& change = nullptr);

// Calls f once for each target that was compiled and that this machine runs, with that target chosen; restores
// afterwards.
void for_each_target(const std::function<void(const char* name)>& f);

// The plan of test_scene().
Plan test_plan(const Settings& settings = {});

}  // namespace lanewise::test
