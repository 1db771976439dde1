// Rays alone: Lanewise's kernels against Embree's single-ray kernels, on the same rays of the same scenes, one thread.
//   build/traversal_bench [--json FILE] [--runs N] [--isa NAME] SCENE...
// The rays are those that a render traces from the camera, from bounces 1 to 4, and towards the light. Each set is traced
// in turn by Embree, by our tree alone (every triangle in it) and with the plan, N times; the figures are medians, in
// million rays a second and core. Afterwards the distances are compared: what is timed must be right.
#include <algorithm>
#include <ctime>
#include <cmath>
#include <fstream>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/render.h"
#include "core/isa.h"
#include "kernels/kernels.h"
#include "perf/embree_scene.h"
#include "perf/ray_sets.h"
#include "scenes/load.h"

namespace lanewise::perf {
namespace {

constexpr uint32_t kBounces = 4;

struct Options {
  std::vector<std::string> scenes;
  std::string json;
  std::string isa;
  int runs = 5;
};

// Of this thread's own work, whatever else the machine does.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class F>
double seconds(F f) {
  const double start = thread_seconds();
  f();
  return thread_seconds() - start;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

void trace(const Plan& plan, const RaySet& set) {
  for (size_t w = 0; w < set.waves.size(); ++w) {
    (set.shadow ? occlude : intersect)(plan, set.waves[w].state(), {0, set.counts[w]});
  }
}

// Of closest hits, ours (in the set after trace) against Embree's: the share of rays that are off by more than 1e-4 of
// the distance.
double share_off(const RaySet& set, const std::vector<RTCRayHit>& rays) {
  size_t off = 0, at = 0;
  for (size_t w = 0; w < set.waves.size(); ++w) {
    for (uint32_t i = 0; i < set.counts[w]; ++i, ++at) {
      const float ours = set.waves[w].state().t[i], theirs = rays[at].ray.tfar;
      off += ours != theirs && !(std::abs(ours - theirs) <= 1e-4f * theirs);
    }
  }
  return static_cast<double>(off) / static_cast<double>(at);
}

// Of shadow rays: what occlude adds to L says whether a ray was blocked.
double share_off(const Plan& plan, const RaySet& set, const std::vector<RTCRay>& rays) {
  size_t off = 0, at = 0;
  for (size_t w = 0; w < set.waves.size(); ++w) {
    const PathState& s = set.waves[w].state();
    for (float* L : {s.L_r, s.L_g, s.L_b}) std::fill_n(L, set.counts[w], 0.0f);
    occlude(plan, s, {0, set.counts[w]});
    for (uint32_t i = 0; i < set.counts[w]; ++i, ++at) {
      off += (std::max({s.L_r[i], s.L_g[i], s.L_b[i]}) > 0) == (rays[at].tfar < 0);
    }
  }
  return static_cast<double>(off) / static_cast<double>(at);
}

struct Row {
  double embree = 0, tree = 0, plan = 0;  // seconds
  double tree_off = 0, plan_off = 0;      // shares of rays
};

Row measure(const RaySet& set, const EmbreeScene& embree, const Plan& tree, const Plan& plan, int runs) {
  const std::vector<RTCRay> fresh = embree_rays(set);
  std::vector<double> times[3];
  std::vector<RTCRay> shadows;
  std::vector<RTCRayHit> hits(set.shadow ? 0 : fresh.size());
  for (int run = 0; run <= runs; ++run) {  // the first one warms up
    double t;
    if (set.shadow) {
      shadows = fresh;
      t = seconds([&] { embree.occluded(shadows); });
    } else {
      for (size_t i = 0; i < hits.size(); ++i) {
        hits[i].ray = fresh[i];
        hits[i].hit.geomID = hits[i].hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      }
      t = seconds([&] { embree.intersect(hits); });
    }
    const double in_tree = seconds([&] { trace(tree, set); });
    const double in_plan = seconds([&] { trace(plan, set); });
    if (run == 0) continue;
    times[0].push_back(t);
    times[1].push_back(in_tree);
    times[2].push_back(in_plan);
  }
  Row row{median(times[0]), median(times[1]), median(times[2])};
  if (set.shadow) {
    row.tree_off = share_off(tree, set, shadows);
    row.plan_off = share_off(plan, set, shadows);
  } else {
    row.plan_off = share_off(set, hits);
    trace(tree, set);
    row.tree_off = share_off(set, hits);
  }
  return row;
}

nlohmann::json bench(const std::string& path, const Options& options) {
  Scene scene = load_scene(path);
  apply_normals(scene, Normals::kFlat);
  Settings settings;
  settings.view = View::kFit;
  const Plan plan = make_plan(scene, settings);
  settings.accel = Accel::kTree;
  const Plan tree = make_plan(scene, settings);
  const EmbreeScene embree(scene, plan.center);

  std::cout
      << path << ": " << scene.triangle_count() << " triangles, " << scene.spheres.size() << " spheres\n"
      << "  rays         number   embree     tree     plan   tree/embree  plan/embree   (million rays/s and core)\n";
  nlohmann::json out{{"scene", path}, {"triangles", scene.triangle_count()}, {"spheres", scene.spheres.size()}};
  for (const RaySet& set : collect_rays(plan, kBounces)) {
    if (set.rays() == 0) continue;
    const Row row = measure(set, embree, tree, plan, options.runs);
    const double millions = static_cast<double>(set.rays()) * 1e-6;
    char line[160];
    std::snprintf(line, sizeof line, "  %-9s %9zu %8.1f %8.1f %8.1f %12.2fx %11.2fx\n", set.name.c_str(), set.rays(),
                  millions / row.embree, millions / row.tree, millions / row.plan, row.embree / row.tree,
                  row.embree / row.plan);
    std::cout << line << std::flush;
    // Rays along shared edges and silhouettes may fall otherwise, for Embree's default test is not watertight.
    constexpr double kMaxOff = 1e-3;
    if (row.tree_off > kMaxOff || row.plan_off > kMaxOff) {
      throw Error(path + ": " + set.name + ": tree and plan differ from Embree in " + std::to_string(row.tree_off) +
                  " and " + std::to_string(row.plan_off) + " of the rays");
    }
    out["sets"].push_back({{"rays", set.name},
                           {"number", set.rays()},
                           {"embree_mrays", millions / row.embree},
                           {"tree_mrays", millions / row.tree},
                           {"plan_mrays", millions / row.plan},
                           {"tree_off", row.tree_off},
                           {"plan_off", row.plan_off}});
  }
  return out;
}

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto value = [&] {
      if (++i >= argc) throw Error(word + ": a value is missing");
      return std::string(argv[i]);
    };
    if (word == "--json") {
      options.json = value();
    } else if (word == "--runs") {
      options.runs = std::max(1, std::stoi(value()));
    } else if (word == "--isa") {
      options.isa = value();
    } else if (word.starts_with("-")) {
      throw Error(word + ": unknown; traversal_bench [--json FILE] [--runs N] [--isa NAME] SCENE...");
    } else {
      options.scenes.push_back(word);
    }
  }
  if (options.scenes.empty()) options.scenes = {"scenes/cornell_spheres.dae", "builtin:dense", "builtin:dense:1000000"};
  return options;
}

}  // namespace
}  // namespace lanewise::perf

int main(int argc, char** argv) {
  using namespace lanewise;
  try {
    const perf::Options options = perf::parse(argc, argv);
    choose_isa(options.isa);
    nlohmann::json all{{"isa", chosen_isa()}, {"scenes", nlohmann::json::array()}};
    for (const std::string& scene : options.scenes) all["scenes"].push_back(perf::bench(scene, options));
    if (!options.json.empty() && !(std::ofstream(options.json) << all.dump(2) << "\n")) {
      throw Error(options.json + ": cannot write");
    }
  } catch (const std::exception& e) {
    std::cerr << "traversal_bench: " << e.what() << "\n";
    return 1;
  }
}
