// The paths that a kernel meets while a scene is rendered, recorded on the scalar path tracer's way: real rays, real hits.
#pragma once

#include <span>
#include <vector>

#include "core/path_state.h"
#include "core/plan.h"
#include "core/stages.h"
#include "kernels/kernels.h"

namespace lanewise {

// A kernel that computes a path's fields, with its float twin.
struct StageTwin {
  Stage stage;
  Kernel* kernel;
  void (*twin)(const Plan&, Path<float>&);
};
std::span<const StageTwin> stage_twins();

// `count` paths as they come to the stage: at the first bounce (roulette: where it begins), in the order of the picture's
// pixels, after intersect sorted by bin. For generate they have nothing but pixel, sample and slot; else what the stages before
// leave, also the LOCAL fields. The plan must have such paths.
std::vector<Path<float>> record_paths(const Plan& plan, Stage stage, uint32_t count);

}  // namespace lanewise
