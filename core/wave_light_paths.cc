// Light paths: see core/plan_light_paths.h.
#include "core/plan_light_paths.h"
#include "core/wave.h"

namespace lanewise {

void Wave::run_light_paths(const LightPiece& piece, Splats& splats) {
  const auto wave = profiler_.wave(piece.count);
  const Settings& settings = plan_.settings;
  state_.batch = {.first_path = piece.first, .paths = piece.count};
  state_.step = {.light = piece.light, .epoch = piece.epoch, .from_light = true};
  Range live{0, piece.count};
  uint32_t paths = piece.count;
  run(Stage::kEmit, live);
  profile_.light_paths += piece.count;

  for (uint32_t bounce = 0; paths > 0; ++bounce) {
    state_.step.bounce = bounce;
    run(Stage::kIntersect, live, paths);
    const Bins bins = sort(live, paths);
    profile_.count_rays(Stage::kIntersect, bounce, bins.paths(0, kBinCount) - bins.dead);
    // What comes to a diffuse surface straight from the lamp is left to paths from the camera.
    const uint32_t first_bin = bounce == 0 ? kDiffuse + 1 : kDiffuse;
    live = bins.span(first_bin, kSurfaceBins);
    paths = bins.paths(first_bin, kSurfaceBins);
    run(Stage::kSurface, live, paths);
    take_adjoint(live, paths, false);
    if (bounce > 0) {
      if (!plan_.textures.empty()) run(Stage::kTexture, bins[kDiffuse]);
      if (settings.shows(bounce + 1)) see(bins[kDiffuse], splats);
    }
    if (bounce + 1 == settings.max_depth) break;
    for (const ShadeStages& stages : plan_.shade_stages) {
      if (stages.bin >= first_bin) run(stages.shade, bins[stages.bin]);
    }
    take_adjoint(live, paths, true);
    if (bounce >= kRouletteBounce) run(Stage::kRoulette, live, paths);
  }
}

// The camera sees the vertices of the range.
void Wave::see(Range vertices, Splats& splats) {
  run(Stage::kConnectCamera, vertices);
  profile_.count_rays(Stage::kOcclude, state_.step.bounce, count_shadow_rays(state_, vertices));
  run(Stage::kOcclude, vertices);
  if (vertices.empty()) return;
  const auto call = count(Stage::kSplat, vertices, vertices.size());
  profile_.invalid_samples += add_splats(state_, vertices, splats);
}

void Wave::take_adjoint(Range range, uint32_t paths, bool leaving) {
  if (plan_.prim_normals.empty()) return;
  state_.step.leaving = leaving;
  run(Stage::kAdjoint, range, paths);
}

}  // namespace lanewise
