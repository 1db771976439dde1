// Runs a kernel against its scalar twin on every target that this machine can run.
#pragma once

#include <functional>
#include <random>
#include <string>
#include <vector>

#include "core/path_buffer.h"
#include "core/plan.h"
#include "kernels/kernels.h"
#include "kernels/reference/vec3.h"
#include "tests/random_path.h"

namespace lanewise::test {

// How far a written field may be from the float twin: |kernel - twin| <= abs + rel |twin|. uint32_t fields must be
// equal.
struct Write {
  std::string field;
  double abs = 0;
  double rel = 0;
};

struct KernelCase {
  std::function<void(const Plan&, const PathState&, Range)> kernel;
  std::function<void(const Plan&, Path<float>&)> twin;
  std::vector<Write> writes;  // every other field must keep its bits
  // Paths for which a discrete choice may fall either way (a hit within rounding of an edge, say) and are not compared.
  std::function<bool(const Path<float>& before, const Path<float>& after_twin)> borderline = nullptr;
  double max_borderline = 0.01;  // share of paths that may be so
  Step step = {};
};

// Runs the case for 0 .. 2 * kLanes and 1000 paths on every supported target, each path filled by fill after
// fill_random, with doctest checks that name target, field and lane. Also checks that fields not in `writes` keep their
// bits.
void check_kernel(const Plan& plan, const KernelCase& test,
                  const std::function<void(std::mt19937&, Path<float>&)>& fill = nullptr);

// Calls f once for each target that was compiled and that this machine runs, with that target chosen; restores
// afterwards.
void for_each_target(const std::function<void(const char* name)>& f);

// The plan of test_scene().
Plan test_plan(const Settings& settings = {});

}  // namespace lanewise::test
