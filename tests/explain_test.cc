#include "core/explain.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "core/path_buffer.h"
#include "core/render.h"
#include "core/scene.h"
#include "core/splats.h"
#include "core/verify/test_scene.h"
#include "kernels/kernels.h"

namespace lanewise {
namespace {

Settings small() {
  Settings settings;
  settings.width = 32, settings.height = 24, settings.threads = 1;
  return settings;
}

const Decision* find(const std::vector<Decision>& decisions, const std::string& topic, const std::string& subject) {
  const auto found =
      std::ranges::find_if(decisions, [&](const Decision& d) { return d.topic == topic && d.subject == subject; });
  return found == decisions.end() ? nullptr : &*found;
}

double figure(const Decision& decision, const std::string& name) {
  const auto found = std::ranges::find_if(decision.figures, [&](const Figure& f) { return name == f.name; });
  REQUIRE(found != decision.figures.end());
  return found->value;
}

double sum(const std::vector<Decision>& decisions, const std::string& topic, const std::string& name) {
  double total = 0;
  for (const Decision& d : decisions) {
    for (const Figure& f : d.figures) total += d.topic == topic && name == f.name ? f.value : 0;
  }
  return total;
}

Scene without(Scene scene, std::initializer_list<Material::Kind> kinds) {
  for (Material& material : scene.materials) {
    if (std::ranges::find(kinds, material.kind) != kinds.end()) material.kind = Material::Kind::kDiffuse;
  }
  return scene;
}

// The stages that a render calls must be those that are said to run.
void check_stages(const Scene& scene, const Settings& settings) {
  const Plan plan = make_plan(scene, settings);
  const Profile profile = render(plan).profile;
  const std::vector<Decision> decisions = explain(plan);
  for (int i = 0; i < kStageCount; ++i) {
    CAPTURE(kStageNames[i]);
    const Decision* decision = find(decisions, "stages", kStageNames[i]);
    REQUIRE(decision);
    const bool ran = profile.total(static_cast<Stage>(i)).calls > 0;
    CHECK(decision->choice == (ran ? "runs" : "left out"));
    if (!ran) CHECK(!decision->reason.empty());
  }
}

}  // namespace

TEST_CASE("explain: the stages said to run are those that a render calls") {
  using Kind = Material::Kind;
  const Scene all = test::test_scene();
  for (const Direct direct : {Direct::kMis, Direct::kLight, Direct::kBsdf, Direct::kHemisphere}) {
    Settings settings = small();
    settings.direct = direct;
    check_stages(all, settings);
  }
  for (const uint32_t depth : {0u, 1u, 4u, 9u}) {
    Settings settings = small();
    settings.max_depth = depth;
    check_stages(all, settings);
  }
  check_stages(without(all, {Kind::kMirror, Kind::kGlass}), small());
  check_stages(without(all, {Kind::kMicrofacet}), small());
  Scene mirrors = all;
  for (Material& m : mirrors.materials) {
    if (m.kind != Kind::kEmission) m.kind = Kind::kMirror;
  }
  check_stages(mirrors, small());
  Scene lit = all;
  lit.environment = test::test_sky();
  for (const Direct direct : {Direct::kMis, Direct::kHemisphere, Direct::kBsdf}) {
    Settings settings = small();
    settings.direct = direct;
    check_stages(lit, settings);
  }
}

TEST_CASE("explain: why stages are left out") {
  Settings settings = small();
  const Scene plain = without(test::test_box(), {Material::Kind::kMirror, Material::Kind::kGlass});
  CHECK(why_left_out(make_plan(plain, settings), Stage::kShadeGlass) == "no glass");
  CHECK(why_left_out(make_plan(plain, settings), Stage::kShadeMirror) == "no mirror");
  CHECK(why_left_out(make_plan(plain, settings), Stage::kRoulette).empty());
  settings.max_depth = 3;
  CHECK(why_left_out(make_plan(plain, settings), Stage::kRoulette) == "-m 3: paths end before bounce 4");
  settings.direct = Direct::kBsdf;
  CHECK(why_left_out(make_plan(plain, settings), Stage::kSharePaths).empty());
  CHECK(why_left_out(make_plan(plain, settings), Stage::kOcclude).empty());  // between the paths' vertices
  settings.reuse = false;
  CHECK(why_left_out(make_plan(plain, settings), Stage::kSharePaths) == "--reuse off");
  CHECK(why_left_out(make_plan(plain, settings), Stage::kOcclude) == "--direct bsdf: lights are found by chance");
}

TEST_CASE("explain: which vertices take light samples") {
  using Kind = Material::Kind;
  Settings settings = small();
  const auto choice = [&](const Scene& scene) {
    const std::vector<Decision> decisions = explain(make_plan(scene, settings));
    const Decision* decision = find(decisions, "light", "vertices");
    return decision ? decision->choice : "none";
  };
  CHECK(choice(test::test_box()) == "light samples at some");
  CHECK(choice(without(test::test_box(), {Kind::kMirror, Kind::kGlass})) == "light samples at all");
  settings.direct = Direct::kBsdf;
  CHECK(choice(test::test_box()) == "none");
}

TEST_CASE("explain: figures of geometry are the plan's") {
  for (const Accel accel : {Accel::kPlan, Accel::kTree}) {
    Settings settings = small();
    settings.accel = accel;
    const Plan plan = make_plan(test::test_scene(), settings);
    const std::vector<Decision> decisions = explain(plan);
    CHECK(sum(decisions, "geometry", "triangles") == plan.triangles);
    CHECK(sum(decisions, "geometry", "spheres") == plan.spheres);
    CHECK(sum(decisions, "geometry", "parallelograms") == plan.flat_quads.size());
    CHECK(sum(decisions, "geometry", "faces_tested") == plan.flat_quads.size() + plan.flat_triangles.size());
    CHECK(sum(decisions, "geometry", "for_shadows") == plan.blocking_quads + plan.blocking_triangles);
    const Decision* tree = find(decisions, "trees", "triangles");
    REQUIRE(tree);
    std::set<uint32_t> prims;
    for (const TriangleBlock& block : plan.triangle_blocks) prims.insert(block.prim, block.prim + kLeafWidth);
    prims.erase(kNoPrim);
    CHECK(figure(*tree, "primitives") == prims.size());
    CHECK(figure(*tree, "nodes") == plan.triangle_tree.nodes.size());
    CHECK(figure(*tree, "depth") == plan.triangle_tree.depth);
    CHECK(figure(*tree, "leaf_blocks") == plan.triangle_blocks.size());
    CHECK(figure(*tree, "fill") ==
          doctest::Approx(static_cast<double>(prims.size()) / static_cast<double>(8 * plan.triangle_blocks.size())));
    // A ray that meets the bounds visits the root, and on average no more than all there is.
    CHECK(figure(*tree, "node_visits") >= 1);
    CHECK(figure(*tree, "node_visits") <= plan.triangle_tree.nodes.size());
    CHECK(figure(*tree, "block_visits") > 0);
    CHECK(figure(*tree, "block_visits") <= plan.triangle_blocks.size());
    CHECK((find(decisions, "trees", "spheres") != nullptr) == (accel == Accel::kTree));
  }
}

TEST_CASE("explain: many meshes in the tree share a row") {
  Scene scene = test::test_scene();
  for (int i = 0; i < 20; ++i) scene.meshes.push_back(scene.meshes[0]);
  Settings settings = small();
  settings.accel = Accel::kTree;
  const Plan plan = make_plan(scene, settings);
  const std::vector<Decision> decisions = explain(plan);
  CHECK(std::ranges::count_if(decisions, [](const Decision& d) { return d.topic == "geometry"; }) == 2);
  CHECK(sum(decisions, "geometry", "triangles") == plan.triangles);
}

TEST_CASE("explain: memory adds up") {
  Settings settings = small();
  settings.threads = 3;
  settings.wave = 256;
  const Plan plan = make_plan(test::test_scene(), settings);
  const std::vector<Decision> decisions = explain(plan);
  const Decision* all = find(decisions, "memory", "all");
  const Decision* threads = find(decisions, "memory", "paths");
  REQUIRE(all);
  REQUIRE(threads);
  const Decision* scene = find(decisions, "memory", "scene");
  REQUIRE(scene);
  CHECK(sum(decisions, "memory", "bytes") == 2 * figure(*all, "bytes") + figure(*scene, "bytes"));
  const size_t splats = paged_bytes(kSplatRoom * sizeof(Splat));
  CHECK(figure(*threads, "bytes") ==
        3.0 * static_cast<double>(3 * PathBuffer::bytes(256) + KeptBuffer::bytes(256) + splats));
  CHECK(figure(*find(decisions, "memory", "film"), "per_pixel") >= sizeof(PixelSums));
  // An array of a field for every slot, at least.
  CHECK(PathBuffer::bytes(256) >= 256 * 4 * 32);
}

TEST_CASE("explain: in a line") {
  const Decision d{"trees", "spheres", "8 wide", "many", {{"nodes", 3}, {"fill", 0.5, FigureUnit::kShare}}};
  CHECK(one_line(d) == "trees: spheres: 8 wide (nodes 3, fill 0.5); many");
  CHECK(one_line({"stages", "sort", "runs", "", {}}) == "stages: sort: runs");
}

}  // namespace lanewise
