#include "perf/recorded_paths.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "core/plan_connections.h"
#include "kernels/reference/connect_sphere.h"
#include "kernels/reference/emission.h"
#include "kernels/reference/environment.h"
#include "kernels/reference/gather_emission.h"
#include "kernels/reference/generate.h"
#include "kernels/reference/intersect.h"
#include "kernels/reference/occlude.h"
#include "kernels/reference/roulette.h"
#include "kernels/reference/sample_environment.h"
#include "kernels/reference/sample_hemisphere.h"
#include "kernels/reference/sample_light.h"
#include "kernels/reference/shade_diffuse.h"
#include "kernels/reference/shade_glass.h"
#include "kernels/reference/shade_microfacet.h"
#include "kernels/reference/shade_mirror.h"
#include "kernels/reference/surface.h"

namespace lanewise {
namespace {

namespace twin = reference;
constexpr StageTwin kTwins[] = {
    {Stage::kGenerate, generate, twin::generate<float>},
    {Stage::kIntersect, intersect, twin::intersect<float>},
    {Stage::kEmission, emission, twin::emission<float>},
    {Stage::kEnvironment, environment, twin::environment<float>},
    {Stage::kSurface, surface, twin::surface<float>},
    {Stage::kSampleLight, sample_light, twin::sample_light<float>},
    {Stage::kSampleEnvironment, sample_environment, twin::sample_environment<float>},
    {Stage::kSampleHemisphere, sample_hemisphere, twin::sample_hemisphere<float>},
    {Stage::kConnectSphere, connect_sphere, twin::connect_sphere<float>},
    {Stage::kLightDiffuse, light_diffuse, twin::light_diffuse<float>},
    {Stage::kLightMicrofacet, light_microfacet, twin::light_microfacet<float>},
    {Stage::kOcclude, occlude, twin::occlude<float>},
    {Stage::kOccludeConnection, occlude_connection, twin::occlude_connection<float>},
    {Stage::kGatherEmission, gather_emission, twin::gather_emission<float>},
    {Stage::kShadeDiffuse, shade_diffuse, twin::shade_diffuse<float>},
    {Stage::kShadeMicrofacet, shade_microfacet, twin::shade_microfacet<float>},
    {Stage::kShadeMirror, shade_mirror, twin::shade_mirror<float>},
    {Stage::kShadeGlass, shade_glass, twin::shade_glass<float>},
    {Stage::kRoulette, roulette, twin::roulette<float>},
};

void run_twin(const Plan& plan, Stage stage, Path<float>& p) {
  for (const StageTwin& t : kTwins) {
    if (t.stage == stage) return t.twin(plan, p);
  }
}

// What a path that met bin goes through until the next intersect.
std::vector<Stage> stages_at(const Plan& plan, uint32_t bin, uint32_t bounce) {
  const bool hemisphere = plan.settings.direct == Direct::kHemisphere;
  std::vector<Stage> stages = {Stage::kSurface};
  for (const ShadeStages& s : plan.shade_stages) {
    if (s.bin != bin) continue;
    if (s.light != Stage::kCount) {
      stages.insert(stages.end(), {hemisphere ? Stage::kSampleHemisphere : Stage::kSampleLight, s.light,
                                   hemisphere ? Stage::kGatherEmission : Stage::kOcclude});
      if (connects_at(plan, bounce)) {
        stages.insert(stages.end(), {Stage::kConnectSphere, s.light, Stage::kOccludeConnection});
      }
      if (!plan.environment.empty()) {
        stages.insert(stages.end(), {Stage::kSampleEnvironment, s.light, Stage::kOcclude});
      }
    }
    stages.insert(stages.end(), {s.shade, Stage::kRoulette});
  }
  return stages;
}

// Takes the path from the camera to the stage at this bounce; false if it does not come there.
bool trace_to(const Plan& plan, Stage wanted, uint32_t wanted_bounce, Path<float>& p) {
  if (wanted == Stage::kGenerate) return true;
  run_twin(plan, Stage::kGenerate, p);
  for (uint32_t bounce = 0; bounce <= wanted_bounce; ++bounce) {
    const bool there = bounce == wanted_bounce;
    p.step = {.bounce = bounce};
    if (there && wanted == Stage::kIntersect) return true;
    run_twin(plan, Stage::kIntersect, p);
    if (p.bin >= kSurfaceBins) {
      return there &&
             ((wanted == Stage::kEmission && p.bin == kEmitter) || (wanted == Stage::kEnvironment && p.bin == kSky));
    }
    for (const Stage stage : stages_at(plan, p.bin, bounce)) {
      if (stage == Stage::kSampleEnvironment) p.step.light = sampled_lights(plan) - 1;
      if (there && stage == wanted) return true;
      if (stage == Stage::kConnectSphere) p.step.connection = true;
      run_twin(plan, stage, p);
      if (stage == Stage::kOccludeConnection) p.step.connection = false;
    }
  }
  return false;
}

}  // namespace

std::span<const StageTwin> stage_twins() { return kTwins; }

std::vector<Path<float>> record_paths(const Plan& plan, Stage stage, uint32_t count) {
  constexpr uint32_t kSamples = 16, kMostSamples = 1 << 16;
  const uint32_t pixels = plan.settings.width * plan.settings.height;
  const uint32_t bounce = stage == Stage::kRoulette ? kRouletteBounce : 1;
  std::vector<Path<float>> paths;
  for (uint32_t first = 0; first < kMostSamples; first += kSamples) {
    for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
      for (uint32_t sample = first; sample < first + kSamples; ++sample) {
        Path<float> p;
        p.pixel = pixel, p.sample = sample, p.slot = static_cast<uint32_t>(paths.size());
        if (!trace_to(plan, stage, bounce, p)) continue;
        paths.push_back(p);
        if (paths.size() < count) continue;
        if (stage != Stage::kGenerate && stage != Stage::kIntersect)
          std::ranges::stable_sort(paths, {}, &Path<float>::bin);
        return paths;
      }
    }
  }
  throw std::logic_error(std::string("too few paths come to ") + kStageNames[static_cast<size_t>(stage)]);
}

}  // namespace lanewise
