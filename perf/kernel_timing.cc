#include "perf/kernel_timing.h"

#include <cstdlib>
#include <iostream>
#include <map>

#include "core/render.h"
#include "core/verify/test_scene.h"
#include "core/isa.h"
#include "perf/recorded_paths.h"

namespace lanewise {

const Plan& plan_of(Stage stage) {
  const auto make = [](Direct direct, const Scene& scene) {
    Settings settings;
    settings.width = settings.height = kSide, settings.spp = kSamples, settings.direct = direct;
    return make_plan(scene, settings);
  };
  static const Plan usual = make(Direct::kMis, test::test_scene());
  static const Plan hemisphere = make(Direct::kHemisphere, test::test_scene());
  static const Plan outdoors = make(Direct::kMis, test::test_outdoors());
  if (stage == Stage::kEnvironment || stage == Stage::kSampleEnvironment) return outdoors;
  return stage == Stage::kSampleHemisphere || stage == Stage::kGatherEmission ? hemisphere : usual;
}

const Paths& paths_of(Stage stage) {
  static std::map<Stage, Paths> all;
  Paths& paths = all[stage];
  if (paths.empty()) paths = record_paths(plan_of(stage), stage, kPaths);
  return paths;
}

PathBuffer buffer_of(const Paths& paths) {
  // The samples that generate makes of this batch are those that record_paths begins with.
  static const std::vector<uint32_t> pixels = [] {
    std::vector<uint32_t> list(kSide * kSide);
    for (uint32_t i = 0; i < list.size(); ++i) list[i] = i;
    return list;
  }();
  PathBuffer buffer(kPaths);
  PathState& s = buffer.state();
  for (uint32_t i = 0; i < kPaths; ++i) store_path(s, i, paths[i]);
  s.step = paths[0].step;
  s.batch = {.pixels = pixels.data(), .samples = kSamples, .paths = kPaths};
  return buffer;
}

void fail(const std::string& kernel, const std::string& what) {
  std::cerr << "kernels_bench: " << kernel << " on " << chosen_isa() << " is wrong after timing: " << what << "\n";
  std::exit(1);
}

}  // namespace lanewise
