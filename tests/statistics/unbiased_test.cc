// The SIMD renderer's expected picture is the double-precision reference's, and every instruction set's is the same. In
// the same seed's picture both follow the same paths, so bias is looked for in pictures of different seeds, which hide
// nothing, and in pairs of the same seed, which show far smaller errors.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>

#include "core/render.h"
#include "scenes/load.h"
#include "tests/kernel_harness.h"
#include "tests/scene_paths.h"
#include "tests/statistics/renders.h"
#include "core/verify/test_scene.h"
#include "core/isa.h"

TEST_SUITE_BEGIN("statistics");

namespace lanewise {
namespace {

constexpr uint32_t kDepths[] = {0, 1, 2, 3, 4, 5, 100};
#ifdef NDEBUG
constexpr uint32_t kSeeds = 8, kSpp = 16;
#else
constexpr uint32_t kSeeds = 4, kSpp = 4;
#endif

// How much to render.
struct Effort {
  uint32_t width, height, spp, seeds, block;
  double apart;  // largest share of pixels more than 1% apart in pairs of the same seed
};
constexpr Effort kQuick{48, 36, kSpp, kSeeds, 6, 0.03};
constexpr Effort kThorough{64, 48, 32, 16, 4, 0.05};  // its paths among dense smooth triangles part often

Plan plan_of(const Scene& scene, const Effort& effort) {
  Settings settings;
  settings.width = effort.width, settings.height = effort.height, settings.spp = effort.spp, settings.threads = 1;
  return make_plan(scene, settings);
}

struct Verdict {
  test::Unpaired unpaired;
  test::Paired paired;
};

// Judges the SIMD renderer by the reference on one scene at one depth.
Verdict check(const std::string& name, Plan& plan, uint32_t depth, const Effort& effort, test::Family& means) {
  plan.settings.max_depth = depth;
  const std::vector<Image> want = test::independent_renders(plan, test::reference, 1000, effort.seeds);
  const std::vector<Image> other = test::independent_renders(plan, test::simd, 1, effort.seeds);
  const std::vector<Image> same = test::independent_renders(plan, test::simd, 1000, effort.seeds);
  const Verdict verdict{test::compare_unpaired(other, want, effort.block), test::compare_paired(same, want)};
  CAPTURE(name);
  CAPTURE(depth);
  CHECK(verdict.unpaired.pixels_passed >= 0.9975);
  means.add(name + " at -m " + std::to_string(depth), verdict.unpaired.mean_p);
  CHECK(verdict.paired.differing < effort.apart);
  CHECK(std::abs(verdict.paired.difference) < 4 * verdict.paired.error + 1e-6);
  return verdict;
}

struct NamedScene {
  std::string name, path;
};

std::vector<NamedScene> shipped_scenes() {
  std::vector<NamedScene> scenes;
  for (const char* name : {"cornell_spheres.dae", "cornell_metal.dae", "furnace.dae"}) {
    scenes.push_back({name, test::shipped_scene(name).string()});
  }
  return scenes;
}

std::vector<NamedScene> course_scenes() {
  std::vector<NamedScene> scenes;
  for (const char* name :
       {"CBempty.dae", "CBspheres.dae", "CBspheres_lambertian.dae", "CBspheres_microfacet_al_ag.dae", "CBbunny.dae",
        "CBbunny_glass.dae", "CBbunny_microfacet_cu.dae", "CBdragon_microfacet_au.dae"}) {
    const std::filesystem::path path = test::course_scenes() / name;
    if (std::filesystem::exists(path)) scenes.push_back({name, path.string()});
  }
  return scenes;
}

Scene load_with(const NamedScene& scene, Normals normals) {
  Scene loaded = load_scene(scene.path);
  apply_normals(loaded, normals);
  return loaded;
}

}  // namespace

TEST_CASE("unbiased: SIMD against double reference, shipped scenes, every depth") {
  test::Family means;
  for (const NamedScene& scene : shipped_scenes()) {
    Plan plan = plan_of(load_with(scene, Normals::kFile), kQuick);
    for (const uint32_t depth : kDepths) check(scene.name, plan, depth, kQuick, means);
  }
  for (const Normals normals : {Normals::kFlat, Normals::kSmooth}) {
    Scene scene = test::test_scene();
    apply_normals(scene, normals);
    Plan plan = plan_of(scene, kQuick);
    for (const uint32_t depth : {2u, 5u}) {
      check(normals == Normals::kFlat ? "one of everything, flat" : "one of everything, smooth", plan, depth, kQuick,
            means);
    }
  }
  CHECK_MESSAGE(means.holds(), means.least_likely());
}

TEST_CASE("unbiased: SIMD against double reference, course scenes where they are at hand") {
  test::Family means;
  for (const NamedScene& scene : course_scenes()) {
    Plan plan = plan_of(load_with(scene, Normals::kFile), kQuick);
    for (const uint32_t depth : {1u, 5u}) check(scene.name, plan, depth, kQuick, means);
  }
  CHECK_MESSAGE(means.holds(), means.least_likely());
}

TEST_CASE("unbiased: p-values between instruction sets are uniform") {
  // Sixteen pictures of many samples, blocks of 6 x 6: near enough to normal for the histogram to be flat.
  constexpr Effort kEffort{48, 36, kSpp, 2 * kSeeds, 6, 0};
  Plan plan = plan_of(test::test_scene(), kEffort);
  std::vector<double> p_values;
  test::Family means;
  std::vector<std::string> names;
  std::vector<std::vector<Image>> pictures;
  test::for_each_target([&](const char* target) {
    names.push_back(target);
    pictures.push_back(test::independent_renders(plan, test::simd, 100 * (pictures.size() + 1), kEffort.seeds));
  });
  for (size_t i = 0; i < names.size(); ++i) {
    for (size_t j = i + 1; j < names.size(); ++j) {
      const test::Unpaired result = test::compare_unpaired(pictures[i], pictures[j], kEffort.block);
      CAPTURE(names[i]);
      CAPTURE(names[j]);
      CHECK(result.pixels_passed >= 0.9975);
      CHECK(test::uniform_p(result.block_p) > 0.003);
      means.add(names[i] + " against " + names[j], result.mean_p);
    }
  }
  CHECK_MESSAGE(means.holds(), means.least_likely());
}

TEST_CASE("unbiased: a renderer with 1% less albedo is found out, its like is not") {
  Scene darker = test::test_box();
  for (Material& m : darker.materials) m.reflectance *= 0.99;
  constexpr Effort kEffort{48, 36, 4 * kSpp, 2 * kSeeds, 6, 0};
  Plan right = plan_of(test::test_box(), kEffort), wrong = plan_of(darker, kEffort);
  const std::vector<Image> want = test::independent_renders(right, test::simd, 1000, kEffort.seeds);
  const auto unpaired_p = [&](Plan& plan) {
    return test::compare_unpaired(test::independent_renders(plan, test::simd, 1, kEffort.seeds), want, kEffort.block)
        .mean_p;
  };
  CHECK(unpaired_p(right) > 0.01);
#ifdef NDEBUG
  CHECK(unpaired_p(wrong) < 1e-3);
#endif
  // Pairs of the same seed need far fewer samples.
  const test::Paired pairs = test::compare_paired(test::independent_renders(wrong, test::simd, 1000, 1), {want[0]});
  CHECK(std::abs(pairs.difference) > 20 * pairs.error);
  CHECK(pairs.differing > 0.5);
}

// Every scene, depth and kind of normals: writes perf/results/unbiased.md, which says what the columns are.
TEST_CASE("unbiased: table of every scene, depth and kind of normals" * doctest::skip()) {
  std::ofstream table(test::source_dir() / "perf/results/unbiased.md");
  table << R"(# The SIMD renderer against the double-precision reference

    LANEWISE_SOURCE_DIR=. build/lanewise_tests -tc="unbiased: table*" --no-skip

Pictures of )"
        << kThorough.width << " x " << kThorough.height << " pixels, " << kThorough.spp << " samples each, "
        << kThorough.seeds << R"( seeds a renderer, luminance, on )" << chosen_isa() << R"(.

*Unpaired*: the two renderers take different seeds. Share of pixels whose Welch test passes at Sidak's level for 0.01 (99.75%
must); the same test of the pictures' mean: p, difference over the mean, its standard error; p of the claim that the p-values
of blocks of )"
        << kThorough.block << " x " << kThorough.block << R"( pixels are uniform.
*Paired*: both take the same seeds, so the same paths up to rounding. Share of pixels more than 1% apart, difference of the
means, its standard error.

p of blocks is not fit for scenes with caustics: where one picture alone holds a rare bright path, t is 1 and p 0.33,
whatever the renderer; the histogram at the end shows them.

| scene | normals | `-m` | pixels passed | p of mean | difference | error | p of blocks | pixels apart | difference | error |
|---|---|---|---|---|---|---|---|---|---|---|
)";
  std::vector<NamedScene> scenes = course_scenes();
  for (const NamedScene& scene : shipped_scenes()) scenes.push_back(scene);
  scenes.push_back({"builtin:dense", "builtin:dense"});
  test::Family means;
  std::vector<double> block_p;
  for (const NamedScene& scene : scenes) {
    for (const Normals normals : {Normals::kFlat, Normals::kSmooth}) {
      Plan plan = plan_of(load_with(scene, normals), kThorough);
      const char* kind = normals == Normals::kFlat ? "flat" : "smooth";
      for (const uint32_t depth : kDepths) {
        const Verdict v = check(scene.name + ' ' + kind, plan, depth, kThorough, means);
        char row[512];
        std::snprintf(row, sizeof row,
                      "| %s | %s | %u | %.2f%% | %.3f | %+.1e | %.1e | %.3f | %.3f%% | %+.1e | %.1e |\n",
                      scene.name.c_str(), kind, depth, 100 * v.unpaired.pixels_passed, v.unpaired.mean_p,
                      v.unpaired.difference, v.unpaired.error, test::uniform_p(v.unpaired.block_p),
                      100 * v.paired.differing, v.paired.difference, v.paired.error);
        table << row << std::flush;
        block_p.insert(block_p.end(), v.unpaired.block_p.begin(), v.unpaired.block_p.end());
      }
    }
  }
  CHECK_MESSAGE(means.holds(), means.least_likely());
  table << "\nThe least likely of all means: " << means.least_likely() << ".\n\nOf the p-values of all "
        << block_p.size() << " blocks, each tenth of [0, 1] holds";
  for (const double count : test::histogram_of_ten(block_p)) {
    char share[16];
    std::snprintf(share, sizeof share, " %.1f%%", 100 * count / double(block_p.size()));
    table << share;
  }
  table << ".\n";
}

}  // namespace lanewise

TEST_SUITE_END();
