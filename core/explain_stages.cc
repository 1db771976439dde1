#include <algorithm>
#include <iomanip>
#include <span>
#include <sstream>

#include "core/explain_topics.h"
#include "core/plan_connections.h"
#include "core/path_reuse.h"
#include "core/plan_light_paths.h"
#include "kernels/kernels.h"

namespace lanewise {
namespace {

const char* material_name(Bin bin) {
  switch (bin) {
    case kDiffuse:
      return "diffuse surface";
    case kMicrofacet:
      return "microfacet metal";
    case kRoughGlass:
      return "rough glass";
    case kMirror:
      return "mirror";
    case kGlass:
      return "glass";
    case kEmitter:
    case kSky:
    case kFinished:
    case kBinCount:
      break;
  }
  return "";
}

bool has_bin(const Plan& plan, Bin bin) {
  return std::ranges::any_of(plan.shade_stages, [bin](const ShadeStages& s) { return s.bin == bin; });
}

bool has_rough(const Plan& plan) {
  return has_bin(plan, kDiffuse) || has_bin(plan, kMicrofacet) || has_bin(plan, kRoughGlass);
}

std::string why_nothing_scatters(const Plan& plan) {
  if (plan.settings.max_depth == 0) return "-m 0: no path scatters";
  return plan.shade_stages.empty() ? "nothing in the scene scatters light" : "";
}

std::string why_no_light_samples(const Plan& plan) {
  if (const std::string why = why_nothing_scatters(plan); !why.empty()) return why;
  if (plan.settings.direct == Direct::kBsdf) return "--direct bsdf: lights are found by chance";
  if (!has_rough(plan)) return "only mirrors and glass, which take no light samples";
  return sampled_lights(plan) == 0 ? "no light" : "";
}

std::string why_no_emitter_samples(const Plan& plan) {
  if (plan.settings.direct == Direct::kHemisphere) return "--direct hemisphere";
  const std::string why = why_no_light_samples(plan);
  return why.empty() && plan.lights.empty() ? "no light but the environment" : why;
}

std::string why_no_environment_samples(const Plan& plan) {
  if (plan.environment.empty()) return "no environment map (-e)";
  return plan.settings.direct == Direct::kHemisphere ? "--direct hemisphere" : why_no_light_samples(plan);
}

bool has_delta_sphere(const Plan& plan) {
  const auto bins = std::span(plan.prim_bin).subspan(plan.triangles);
  return std::ranges::any_of(bins, [](uint32_t bin) { return bin == kMirror || bin == kGlass; });
}

std::string why_no_connections(const Plan& plan) {
  if (const std::string why = why_no_emitter_samples(plan); !why.empty()) return why;
  if (!plan.settings.connect) return "--connect off";
  if (!connects(plan)) {
    return has_delta_sphere(plan)
               ? "only for up to " + count_of(kMaxConnectedLights, "light") + " and " +
                     count_of(kMaxConnectedSpheres, "mirror or glass sphere") + ", in places of their own"
               : "no mirror or glass sphere";
  }
  return plan.settings.max_depth >= 2 ? "" : "-m 1: no path meets a light behind a rough surface and a sphere";
}

std::string why_no_material(const Plan& plan, Bin bin) {
  if (const std::string why = why_nothing_scatters(plan); !why.empty()) return why;
  return has_bin(plan, bin) ? "" : std::string("no ") + material_name(bin);
}

std::string why_no_light_stage(const Plan& plan, Bin bin) {
  const std::string why = why_no_material(plan, bin);
  return why.empty() ? why_no_light_samples(plan) : why;
}

// Why a stage that runs is the way it is.
std::string distance_text(double distance) {
  std::ostringstream text;
  text << std::setprecision(4) << distance;
  return text.str();
}

// With --only-bounce, where alone in a path: `ahead` scattering events before the light is met.
std::string only_bounce(const Settings& settings, uint32_t ahead) {
  return settings.only_bounce ? "; only at bounce " + std::to_string(*settings.only_bounce - ahead) : "";
}

std::string light_paths_text(const Plan& plan) {
  uint64_t paths = 0;
  for (const LampPaths& lamp : plan.lamp_paths) paths += lamp.per_pass;
  return count_of(paths, "light path") + " a pass, aimed at " + count_of(plan.casters.size(), "caster");
}

std::string why_so(const Plan& plan, Stage stage) {
  const Settings& settings = plan.settings;
  const bool trees = !plan.triangle_tree.nodes.empty() || !plan.sphere_tree.nodes.empty();
  switch (stage) {
    case Stage::kGenerate:
      return (settings.lens_radius > 0
                  ? "a thin lens, sharp at " + distance_text(settings.focal_distance) + ": a point of it for every path"
                  : std::string("a pinhole: no lens is sampled")) +
             (settings.allocation == Allocation::kNoise ? "; more samples where the first find noise" : "");
    case Stage::kIntersect:
    case Stage::kOcclude:
    case Stage::kOccludeConnection:
    case Stage::kGatherEmission:
      if (!trees) return "flat lists alone: no ray leaves its vector";
      return plan.flat_quads.empty() && plan.flat_triangles.empty() && plan.flat_spheres.empty()
                 ? "trees alone"
                 : "flat lists first, then the trees for rays that meet their bounds";
    case Stage::kSort:
      return count_of(plan.shade_stages.size(), "material") + ", emitters, " +
             (plan.environment.empty() ? "" : "the sky, ") + "finished: a contiguous bin each";
    case Stage::kEmission:
      return settings.only_bounce
                 ? "once a wave, over the paths that met a light at bounce " + std::to_string(*settings.only_bounce)
                 : "once a wave, over the paths of all bounces that met a light";
    case Stage::kEnvironment:
      return settings.only_bounce
                 ? "over the paths that leave the scene at bounce " + std::to_string(*settings.only_bounce)
                 : "at every bounce, over the paths that leave the scene";
    case Stage::kSurface:
      return plan.prim_normals.empty() ? "flat faces alone: no corner normals to fetch and mix"
                                       : "corner normals, mixed by barycentric weights";
    case Stage::kTexture:
      return count_of(plan.textures.size() - 1, "texture") + ": the albedo of every diffuse surface";
    case Stage::kSampleLight:
      return count_of(plan.lights.size(), "light") + ", " + count_of(settings.light_samples, "sample") +
             " each: " + count_of(plan.lights.size() * settings.light_samples, "call") + " a bounce" +
             only_bounce(settings, 1);
    case Stage::kSampleEnvironment:
      return "one more light, " + count_of(settings.light_samples, "sample") +
             ": by luminance, a cell between texels first" + only_bounce(settings, 1);
    case Stage::kSampleHemisphere:
      return "--direct hemisphere, " + count_of(settings.light_samples, "sample") + " a vertex" +
             only_bounce(settings, 1);
    case Stage::kConnectSphere:
      return "light by way of a reflection at " + count_of(plan.connected_spheres.size(), "sphere") +
             ", one chosen by each sample of a light" + only_bounce(settings, 2);
    case Stage::kLightMicrofacet:
    case Stage::kShadeMicrofacet:
      if (settings.course.any()) return "--model: the course program's lobe, not Beckmann's";
      return "";
    case Stage::kTakeLamps:
      return "paths leave caustics to light paths";
    case Stage::kKeepFirst:
      return "of flat diffuse surfaces, and spheres";
    case Stage::kConnectPaths:
      return "light between diffuse surfaces goes to all " + std::to_string(kPathsTogether) +
             " pixels of a square that see where it comes from";
    case Stage::kEmit:
      return light_paths_text(plan);
    case Stage::kAdjoint:
      return "corner normals scatter light paths otherwise";
    case Stage::kConnectCamera:
      return settings.lens_radius > 0 ? "from diffuse vertices to points of the lens" : "from diffuse vertices";
    case Stage::kSplat:
      return "to a film of their own";
    case Stage::kRoulette:
      return "from bounce " + std::to_string(kRouletteBounce) + " on";
    default:
      return "";
  }
}

}  // namespace

std::string why_left_out(const Plan& plan, Stage stage) {
  const bool hemisphere = plan.settings.direct == Direct::kHemisphere;
  switch (stage) {
    case Stage::kEmission:
      return plan.lights.empty() ? "no light" : "";
    case Stage::kSurface:
      return why_nothing_scatters(plan);
    case Stage::kEnvironment:
      return plan.environment.empty() ? "no environment map (-e)" : "";
    case Stage::kSampleLight:
      return why_no_emitter_samples(plan);
    case Stage::kSampleEnvironment:
      return why_no_environment_samples(plan);
    case Stage::kOcclude:
      if (reuses_paths(plan)) return "";
      if (hemisphere) return "--direct hemisphere";
      return why_no_light_samples(plan);
    case Stage::kSampleHemisphere:
    case Stage::kGatherEmission:
      if (!hemisphere) return "only for --direct hemisphere";
      return why_no_light_samples(plan);
    case Stage::kConnectSphere:
    case Stage::kOccludeConnection:
      return why_no_connections(plan);
    case Stage::kTexture:
      return plan.textures.empty() ? "no surface has a texture" : why_nothing_scatters(plan);
    case Stage::kLightTextured:
      return plan.textures.empty() ? "no surface has a texture" : why_no_light_stage(plan, kDiffuse);
    case Stage::kShadeTextured:
      return plan.textures.empty() ? "no surface has a texture" : why_no_material(plan, kDiffuse);
    case Stage::kLightDiffuse:
      return plan.textures.empty() ? why_no_light_stage(plan, kDiffuse) : "the scene has textures: light_textured";
    case Stage::kLightMicrofacet:
      return why_no_light_stage(plan, kMicrofacet);
    case Stage::kShadeDiffuse:
      return plan.textures.empty() ? why_no_material(plan, kDiffuse) : "the scene has textures: shade_textured";
    case Stage::kShadeMicrofacet:
      return why_no_material(plan, kMicrofacet);
    case Stage::kLightRoughGlass:
      return why_no_light_stage(plan, kRoughGlass);
    case Stage::kShadeRoughGlass:
      return why_no_material(plan, kRoughGlass);
    case Stage::kShadeMirror:
      return why_no_material(plan, kMirror);
    case Stage::kShadeGlass:
      return why_no_material(plan, kGlass);
    case Stage::kAdjoint:
      if (*why_no_light_paths(plan) == '\0' && plan.prim_normals.empty()) return "flat faces alone";
      return why_no_light_paths(plan);
    case Stage::kKeepFirst:
    case Stage::kKeepSecond:
    case Stage::kConnectPaths:
    case Stage::kSharePaths:
      return why_no_reuse(plan);
    case Stage::kTakeLamps:
    case Stage::kEmit:
    case Stage::kConnectCamera:
    case Stage::kSplat:
      return why_no_light_paths(plan);
    case Stage::kRoulette:
      if (const std::string why = why_nothing_scatters(plan); !why.empty()) return why;
      if (plan.settings.max_depth > kRouletteBounce) return "";
      return "-m " + std::to_string(plan.settings.max_depth) + ": paths end before bounce " +
             std::to_string(kRouletteBounce);
    default:
      return "";
  }
}

void explain_stages(const Plan& plan, std::vector<Decision>& out) {
  for (int i = 0; i < kStageCount; ++i) {
    const Stage stage = static_cast<Stage>(i);
    const std::string why = why_left_out(plan, stage);
    const bool runs = why.empty();
    out.push_back({"stages", kStageNames[i], runs ? "runs" : "left out", runs ? why_so(plan, stage) : why, {}});
  }
}

void explain_light(const Plan& plan, std::vector<Decision>& out) {
  uint32_t single = 0, spheres = 0;
  for (const PlanLight& light : plan.lights) {
    single += light.patches == 1;
    spheres += light.patches == 0;
  }
  const std::string no_samples = why_no_light_samples(plan);
  std::string reason = "each has its samples: no light is selected";
  if (single + spheres < plan.lights.size()) reason = "each has its samples, on one of its patches by area";
  if (plan.settings.direct == Direct::kHemisphere) reason = "--direct hemisphere: no light is sampled";
  if (!no_samples.empty()) reason = no_samples;
  out.push_back({"light",
                 "lights",
                 count_of(plan.lights.size(), "light"),
                 reason,
                 {{"lights", static_cast<double>(plan.lights.size())},
                  {"spheres", double{1} * spheres},
                  {"patches", static_cast<double>(plan.light_patches.size())}}});
  if (!plan.environment.empty()) {
    const EnvironmentMap& map = plan.environment;
    out.push_back({"light",
                   "environment",
                   std::to_string(map.width) + " x " + std::to_string(map.height) + " texels",
                   "a miss meets it; it comes in over the hull, so that shadow rays test every face",
                   {{"cells", static_cast<double>(map.column_cdf.size())}}});
  }
  if (!no_samples.empty()) return;
  const bool delta = has_bin(plan, kMirror) || has_bin(plan, kGlass);
  out.push_back({"light",
                 "vertices",
                 delta ? "light samples at some" : "light samples at all",
                 delta ? "mirrors and glass are bins behind the others" : "no mirror, no glass",
                 {}});
}

// What the sort of a wave moves: see Wave's constructor.
void explain_state(const Plan& plan, std::vector<Decision>& out) {
  const bool flat = plan.prim_normals.empty(), light = has_light_paths(plan);
  const uint32_t left = (flat ? words("u v") : 0) + (light ? 0 : words("lamps")), moved = words("KEPT") - left;
  const auto figures = [](uint32_t fields) {
    return std::vector<Figure>{{"fields", double{1} * fields}, {"per_path", 4.0 * fields, FigureUnit::kBytes}};
  };
  out.push_back({"state", "living path", "moved by the sort", "the next stages read them", figures(moved)});
  out.push_back({"state", "finished path", "moved by the sort", "slot and radiance: all that retire reads",
                 figures(kRetiredFields)});
  if (flat) {
    out.push_back({"state", "u, v", "left in place", "no corner normals to mix with them", figures(words("u v"))});
  }
  if (!light) out.push_back({"state", "lamps", "left in place", "no light paths", figures(words("lamps"))});
}

}  // namespace lanewise
