#include "core/wave.h"

#include <utility>

#include "core/plan_connections.h"
#include "core/path_reuse.h"
#include "core/plan_light_paths.h"

namespace lanewise {
namespace {

Kernel* kernel_of(Stage stage) {
  switch (stage) {
    case Stage::kGenerate:
      return generate;
    case Stage::kIntersect:
      return intersect;
    case Stage::kEmission:
      return emission;
    case Stage::kEnvironment:
      return environment;
    case Stage::kRetire:
      return retire;
    case Stage::kSurface:
      return surface;
    case Stage::kTexture:
      return texture;
    case Stage::kSampleLight:
      return sample_light;
    case Stage::kSampleEnvironment:
      return sample_environment;
    case Stage::kSampleHemisphere:
      return sample_hemisphere;
    case Stage::kLightDiffuse:
      return light_diffuse;
    case Stage::kLightTextured:
      return light_textured;
    case Stage::kLightMicrofacet:
      return light_microfacet;
    case Stage::kLightRoughGlass:
      return light_rough_glass;
    case Stage::kOcclude:
      return occlude;
    case Stage::kGatherEmission:
      return gather_emission;
    case Stage::kConnectSphere:
      return connect_sphere;
    case Stage::kOccludeConnection:
      return occlude_connection;
    case Stage::kShadeDiffuse:
      return shade_diffuse;
    case Stage::kShadeTextured:
      return shade_textured;
    case Stage::kShadeMicrofacet:
      return shade_microfacet;
    case Stage::kShadeRoughGlass:
      return shade_rough_glass;
    case Stage::kShadeMirror:
      return shade_mirror;
    case Stage::kShadeGlass:
      return shade_glass;
    case Stage::kRoulette:
      return roulette;
    case Stage::kTakeLamps:
      return take_lamps;
    case Stage::kKeepFirst:
      return keep_first;
    case Stage::kKeepSecond:
      return keep_second;
    case Stage::kConnectPaths:
      return connect_paths;
    case Stage::kSharePaths:
      return share_paths;
    case Stage::kEmit:
      return emit;
    case Stage::kAdjoint:
      return adjoint;
    case Stage::kConnectCamera:
      return connect_camera;
    case Stage::kSort:
    case Stage::kSplat:
    case Stage::kAccumulate:
    case Stage::kCount:
      break;
  }
  return nullptr;
}

}  // namespace

void Wave::run(const Batch& batch, PixelSums* film) {
  const auto wave = profiler_.wave(batch.paths);
  const Step start{.epoch = epoch_of(batch.first_sample)};
  state_.batch = batch;
  state_.step = start;
  kept_.clear();
  Range live{0, batch.paths};
  uint32_t paths = batch.paths;
  run(Stage::kGenerate, live);

  for (uint32_t bounce = 0; paths > 0; ++bounce) {
    state_.step.bounce = bounce;
    run(Stage::kIntersect, live, paths);
    const Bins bins = sort(live, paths);
    if (bounce == 0) profile_.samples += bins.paths(0, kBinCount);
    profile_.count_rays(Stage::kIntersect, bounce, bins.paths(0, kBinCount) - bins.dead);
    const bool shown = plan_.settings.shows(bounce);
    if (shown) emitters_.append(state_, bins[kEmitter]);
    if (shown) run(Stage::kEnvironment, bins[kSky]);
    const uint32_t ended = shown ? kSky : kEmitter;
    run(Stage::kRetire, bins.span(ended, kBinCount), bins.paths(ended, kBinCount));
    profile_.count_paths(bounce, bins.paths(kSurfaceBins, kBinCount));

    live = bins.span(0, kSurfaceBins);
    paths = bins.paths(0, kSurfaceBins);
    run(Stage::kSurface, live, paths);
    if (!plan_.textures.empty()) run(Stage::kTexture, bins[kDiffuse]);
    take_lamps(bins);
    if (bounce > 0 && bounce <= first_bounces_) run(Stage::kKeepSecond, bins[kDiffuse]);
    add_direct_light(bins);
    for (const ShadeStages& stages : plan_.shade_stages) run(stages.shade, bins[stages.bin]);
    if (bounce < first_bounces_) run(Stage::kKeepFirst, bins[kDiffuse]);
    leave_lamps(live, paths);
    if (bounce >= kRouletteBounce) run(Stage::kRoulette, live, paths);
  }

  // Emission ends a path at whatever bounce: one full range of them costs less than a few at each.
  state_.step = start;
  const Range met = emitters_.take();
  run(Stage::kEmission, emitters_.state(), met, met.size());
  run(Stage::kRetire, emitters_.state(), met, met.size());
  if (first_bounces_ > 0) share_paths({0, batch.paths});

  const auto call = count(Stage::kAccumulate, {0, batch.paths}, batch.paths);
  profile_.invalid_samples += accumulate(state_, film);
}

void Wave::take_lamps(const Bins& bins) {
  if (!has_light_paths(plan_)) return;
  state_.step.diffuse = true;
  run(Stage::kTakeLamps, bins[kDiffuse]);
  state_.step.diffuse = false;
  run(Stage::kTakeLamps, bins.span(kDiffuse + 1, kSurfaceBins), bins.paths(kDiffuse + 1, kSurfaceBins));
}

void Wave::leave_lamps(Range range, uint32_t paths) {
  if (!has_light_paths(plan_) || plan_.prim_normals.empty()) return;
  state_.step.leaving = true;
  run(Stage::kTakeLamps, range, paths);
  state_.step.leaving = false;
}

// Of what paths have found behind their second vertices, by shadow rays from their partners' first ones. By slot: the paths
// themselves are done with.
void Wave::share_paths(Range slots) {
  for (uint32_t partner = 1; partner < kPathsTogether; ++partner) {
    state_.step.partner = partner;
    run(Stage::kConnectPaths, slots);
    profile_.count_rays(Stage::kOcclude, 0, count_shadow_rays(state_, slots));
    run(Stage::kOcclude, slots);
  }
  run(Stage::kSharePaths, slots);
}

// Next-event estimation at the vertices whose materials are no delta: every sample of every light in turn, straight and by
// way of a sphere.
void Wave::add_direct_light(const Bins& bins) {
  const Settings& settings = plan_.settings;
  if (bins.paths(0, kRoughBins) == 0 || settings.direct == Direct::kBsdf) return;
  const bool hemisphere = settings.direct == Direct::kHemisphere;  // meets all lights at once
  const uint32_t bounce = state_.step.bounce;
  const bool straight = settings.shows(bounce + 1), connects = connects_at(plan_, bounce);
  if (!straight && !connects) return;
  const uint32_t lights = hemisphere ? 1 : sampled_lights(plan_);
  for (uint32_t light = 0; light < lights; ++light) {
    for (uint32_t sample = 0; sample < settings.light_samples; ++sample) {
      state_.step.light = light;
      state_.step.light_sample = sample;
      const bool sky = !hemisphere && is_environment(plan_, light);
      if (straight && hemisphere) {
        add_light_sample(bins, Stage::kSampleHemisphere, Stage::kGatherEmission, 1);
      } else if (straight && sky) {
        add_light_sample(bins, Stage::kSampleEnvironment, Stage::kOcclude, 1);
      } else if (straight) {
        add_light_sample(bins, Stage::kSampleLight, Stage::kOcclude, 1);
      }
      if (!connects || sky) continue;
      state_.step.connection = true;
      add_light_sample(bins, Stage::kConnectSphere, Stage::kOccludeConnection, 2);
      state_.step.connection = false;
    }
  }
}

void Wave::add_light_sample(const Bins& bins, Stage aim, Stage trace, uint32_t rays) {
  const Range rough = bins.span(0, kRoughBins);
  const uint32_t paths = bins.paths(0, kRoughBins);
  run(aim, rough, paths);
  for (const ShadeStages& stages : plan_.shade_stages) {
    if (stages.light != Stage::kCount) run(stages.light, bins[stages.bin]);
  }
  profile_.count_rays(trace, state_.step.bounce, rays * count_shadow_rays(state_, rough));
  run(trace, rough, paths);
}

void Wave::run(Stage stage, const PathState& s, Range range, uint32_t paths) {
  if (paths == 0) return;
  const auto call = count(stage, range, paths);
  kernel_of(stage)(plan_, s, range);
}

Profiler::Call Wave::count(Stage stage, Range range, uint32_t paths) {
  return profiler_.call(stage, state_.step.bounce, paths, round_up_to_lanes(range.size()));
}

Bins Wave::sort(Range range, uint32_t paths) {
  const auto call = count(Stage::kSort, range, paths);
  const Bins bins = sort_by_bin(state_, spare_, range);
  spare_.step = state_.step;
  spare_.batch = state_.batch;
  std::swap(state_, spare_);
  return bins;
}

size_t Wave::bytes(const Plan& plan, uint32_t size) {
  return 3 * PathBuffer::bytes(size) + (reuses_paths(plan) ? KeptBuffer::bytes(size) : 0);
}

Wave::Wave(const Plan& plan, uint32_t size, ProfileDetail detail)
    : plan_(plan),
      size_(size),
      first_bounces_(first_bounces(plan)),
      memory_(bytes(plan, size) / sizeof(float)),
      buffers_{PathBuffer(size, memory(0)), PathBuffer(size, memory(1))},
      state_(buffers_[0].state()),
      spare_(buffers_[1].state()),
      emitters_(state_, memory(2)),
      kept_(first_bounces_ > 0 ? size : 0, memory(3)),
      profiler_(detail) {
  spare_.result_r = state_.result_r;
  spare_.result_g = state_.result_g;
  spare_.result_b = state_.result_b;
  state_.kept = spare_.kept = kept_.vertices();
  if (!has_light_paths(plan)) spare_.lamps = state_.lamps;
  // Barycentric weights that no normal is mixed with need not survive the sort: it leaves what both states share in its place.
  if (plan.prim_normals.empty()) {
    spare_.u = state_.u;
    spare_.v = state_.v;
  }
}

}  // namespace lanewise
