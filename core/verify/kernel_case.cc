#include "core/verify/kernel_case.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "core/plan_light_paths.h"
#include "core/verify/fills.h"
#include "kernels/reference/adjoint.h"
#include "kernels/reference/connect_camera.h"
#include "kernels/reference/connect_sphere.h"
#include "kernels/reference/emission.h"
#include "kernels/reference/emit.h"
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
#include "kernels/reference/shade_rough_glass.h"
#include "kernels/reference/surface.h"
#include "kernels/reference/take_lamps.h"
#include "kernels/reference/texture.h"

namespace lanewise::verify {
namespace {

// The pixels come from the paths, one sample each.
void generate_batch(const Plan& plan, const PathState& s, Range range) {
  const std::vector<uint32_t> pixels(s.pixel, s.pixel + range.end);
  PathState with_batch = s;
  with_batch.batch = {.pixels = pixels.data(), .samples = 1, .first_sample = s.sample[range.begin], .paths = range.end};
  generate(plan, with_batch, range);
}

// The paths are numbered as they lie.
void emit_batch(const Plan& plan, const PathState& s, Range range) {
  PathState with_batch = s;
  with_batch.batch = {.first_path = kFirstLightPath, .paths = range.end};
  emit(plan, with_batch, range);
}

// What kernels need that not every plan and step has.
bool is_light(const Plan& plan, const Step& step) { return !is_environment(plan, step.light); }
bool connected(const Plan& plan, const Step& step) { return connects(plan) && is_light(plan, step); }
bool lit(const Plan& plan, const Step& step) { return has_light_paths(plan) && is_light(plan, step); }
bool has_sky(const Plan& plan, const Step&) { return !plan.environment.empty(); }
bool has_textures(const Plan& plan, const Step&) { return !plan.textures.empty(); }

// Does nothing where it is missing.
template <auto kCondition, Kernel* kKernel>
void run_if(const Plan& plan, const PathState& s, Range range) {
  if (kCondition(plan, s.step)) kKernel(plan, s, range);
}
template <auto kCondition, auto kTwin>
void twin_if(const Plan& plan, Path<double>& p) {
  if (kCondition(plan, p.step)) kTwin(plan, p);
}

template <Bin kBin, auto kFill>
void fill_of_bin(const Plan& plan, std::mt19937& rng, Path<float>& p) {
  kFill(plan, rng, p);
  set_prim(plan, rng, p, kBin);
}

namespace twin = reference;
constexpr auto kLight = fill_light_sample;
constexpr auto kShade = fill_shading_point;

const KernelCase kCases[] = {
    {"generate", generate_batch, twin::generate<double>, kGenerateBounds, "", fill_camera_path},
    {"intersect", intersect, twin::intersect<double>, kIntersectBounds, "o d", fill_ray},
    {"emission", emission, twin::emission<double>, kEmissionBounds, "t o d pdf", fill_emitter_hit},
    {"environment", run_if<has_sky, environment>, twin_if<has_sky, twin::environment<double>>, kEnvironmentBounds,
     "d pdf", fill_sky_ray},
    {"surface", surface, twin::surface<double>, kSurfaceBounds, "t u v o d", fill_hit},
    {"texture", run_if<has_textures, texture>, twin_if<has_textures, twin::texture<double>>, kTextureBounds, "o",
     fill_of_bin<kDiffuse, kShade>},
    {"sample_light", run_if<is_light, sample_light>, twin_if<is_light, twin::sample_light<double>>, kSampleLightBounds,
     "o n", fill_shading_point},
    {"sample_environment", run_if<has_sky, sample_environment>, twin_if<has_sky, twin::sample_environment<double>>,
     kSampleEnvironmentBounds, "", fill_shading_point},
    {"sample_hemisphere", sample_hemisphere, twin::sample_hemisphere<double>, kSampleHemisphereBounds, "d s",
     fill_shading_point},
    {"connect_sphere", run_if<connected, connect_sphere>, twin_if<connected, twin::connect_sphere<double>>,
     kConnectSphereBounds, "o n", fill_rough_point},
    {"light_diffuse", light_diffuse, twin::light_diffuse<double>, kLightDiffuseBounds, "d s l l_pdf",
     fill_of_bin<kDiffuse, kLight>},
    {"shade_diffuse", shade_diffuse, twin::shade_diffuse<double>, kShadeDiffuseBounds, "o d n s",
     fill_of_bin<kDiffuse, kShade>},
    {"light_textured", light_textured, twin::light_textured<double>, kLightTexturedBounds, "d s l l_pdf",
     fill_of_bin<kDiffuse, kLight>},
    {"shade_textured", shade_textured, twin::shade_textured<double>, kShadeTexturedBounds, "o d n s",
     fill_of_bin<kDiffuse, kShade>},
    {"light_microfacet", light_microfacet, twin::light_microfacet<double>, kLightMicrofacetBounds, "d s l l_pdf",
     fill_of_bin<kMicrofacet, kLight>},
    {"shade_microfacet", shade_microfacet, twin::shade_microfacet<double>, kShadeMicrofacetBounds, "o d n s",
     fill_of_bin<kMicrofacet, kShade>},
    {"light_rough_glass", light_rough_glass, twin::light_rough_glass<double>, kLightRoughGlassBounds, "d s l l_pdf",
     fill_of_bin<kRoughGlass, kLight>},
    {"shade_rough_glass", shade_rough_glass, twin::shade_rough_glass<double>, kShadeRoughGlassBounds, "o d n s",
     fill_of_bin<kRoughGlass, kShade>},
    {"shade_mirror", shade_mirror, twin::shade_mirror<double>, kShadeMirrorBounds, "o d n s",
     fill_of_bin<kMirror, kShade>},
    {"shade_glass", shade_glass, twin::shade_glass<double>, kShadeGlassBounds, "o d n s", fill_of_bin<kGlass, kShade>},
    {"occlude", occlude, twin::occlude<double>, kOccludeBounds, "o n l", fill_shadow_ray},
    {"occlude_connection", run_if<connected, occlude_connection>, twin_if<connected, twin::occlude_connection<double>>,
     kOccludeConnectionBounds, "o n l m", fill_connection},
    {"gather_emission", gather_emission, twin::gather_emission<double>, kGatherEmissionBounds, "o n l",
     fill_shadow_ray},
    {"take_lamps", run_if<lit, take_lamps>, twin_if<lit, twin::take_lamps<double>>, kTakeLampsBounds, "d n s",
     fill_shading_point},
    {"emit", run_if<lit, emit_batch>, twin_if<lit, twin::emit<double>>, kEmitBounds, "", fill_light_path},
    {"adjoint", adjoint, twin::adjoint<double>, kAdjointBounds, "d n s", fill_shading_point},
    {"connect_camera", run_if<lit, connect_camera>, twin_if<lit, twin::connect_camera<double>>, kConnectCameraBounds,
     "o d n s", fill_of_bin<kDiffuse, kShade>},
    {"roulette", roulette, twin::roulette<double>, kRouletteBounds, "beta", fill_throughput},
};

}  // namespace

std::span<const KernelCase> kernel_cases() { return kCases; }

const KernelCase& kernel_case(const std::string& name) {
  for (const KernelCase& c : kCases) {
    if (c.name == name) return c;
  }
  throw std::logic_error("no kernel " + name);
}

}  // namespace lanewise::verify
