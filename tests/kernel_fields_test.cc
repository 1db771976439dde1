// The fields that kernels.h says a kernel reads and writes are those that it does: what is not in its list of reads may hold
// anything, and every name in its lists matters.
#include "kernels/fields.h"

#include <doctest/doctest.h>

#include <iterator>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "core/path_buffer.h"
#include "core/plan_light_paths.h"
#include "core/stage_fields.h"
#include "core/verify/kernel_case.h"
#include "core/verify/plans.h"
#include "core/verify/test_scene.h"

namespace lanewise {
namespace {

// So many that even `err` turns a ray of some path in gather_emission from what it met.
constexpr uint32_t kPaths = 8192;

constexpr const char* kNames[] = {
#define LANEWISE_NAME(type, name, meaning) #name,
    LANEWISE_PATH_FIELDS(LANEWISE_NAME, LANEWISE_NAME)
#undef LANEWISE_NAME
};
constexpr size_t kFields = std::size(kNames);

bool is_in(const std::string& field, std::string_view names) {
  bool found = false;
  for_each_name(names, [&](std::string_view name) { found = found || fields_internal::is_part(field, name); });
  return found;
}

Stage stage_of(const verify::KernelCase& kernel) {
  int i = 0;
  while (std::string(kStageNames[i]) != kernel.name) ++i;
  return static_cast<Stage>(i);
}

using Words = std::vector<std::vector<uint32_t>>;  // of each field, of each path; floats as their bits

Words words_of(const PathState& s) {
  return {
#define LANEWISE_WORDS(type, name, meaning) \
  {reinterpret_cast<const uint32_t*>(s.name), reinterpret_cast<const uint32_t*>(s.name) + kPaths},
      LANEWISE_PATH_FIELDS(LANEWISE_WORDS, LANEWISE_WORDS)
#undef LANEWISE_WORDS
  };
}

// Paths that a kernel may meet, and as many others of which the values of a field can be borrowed.
class Trial {
 public:
  Trial(const Plan& plan, const verify::KernelCase& kernel)
      : plan_(plan), kernel_(kernel), paths_(kPaths), others_(kPaths), buffer_(kPaths) {
    std::mt19937 rng(11);
    for (std::vector<Path<float>>* paths : {&paths_, &others_}) {
      for (uint32_t i = 0; i < kPaths; ++i) {
        Path<float>& p = (*paths)[i];
        p.slot = i;
        p.step = {.bounce = kRouletteBounce, .light = sampled_lights(plan) - 1};  // the environment's, if there is one
        kernel.fill(plan, rng, p);
      }
    }
    buffer_.state().step = paths_[0].step;
  }

  Words words() const { return put(""); }

  // What the kernel makes of the paths, the field of that name borrowed.
  Words run(const std::string& borrowed) {
    put(borrowed);
    kernel_.kernel(plan_, buffer_.state(), {0, kPaths});
    return words_of(buffer_.state());
  }

 private:
  Words put(const std::string& borrowed) const {
    for (uint32_t i = 0; i < kPaths; ++i) {
      Path<float> p = paths_[i];
#define LANEWISE_BORROW(type, name, meaning) \
  if (borrowed == #name) p.name = others_[i].name;
      LANEWISE_PATH_FIELDS(LANEWISE_BORROW, LANEWISE_BORROW)
#undef LANEWISE_BORROW
      store_path(buffer_.state(), i, p);
    }
    return words_of(buffer_.state());
  }

  const Plan& plan_;
  const verify::KernelCase& kernel_;
  std::vector<Path<float>> paths_, others_;
  PathBuffer buffer_;
};

}  // namespace

TEST_CASE("kernel fields: names stand for fields") {
  static_assert(words("") == 0);
  static_assert(words("t") == 1);
  static_assert(words("l l_pdf") == 4);  // l is not l_pdf
  static_assert(words("L s beta") == 9);
  static_assert(words("batch result step") == 3);
  static_assert(words("KEPT bin") == words("KEPT") + 1);  // bin is local
  CHECK_THROWS(words("normal"));
}

TEST_CASE("kernel fields: a kernel's bounds are of the fields that it writes") {
  for (const verify::KernelCase& kernel : verify::kernel_cases()) {
    CAPTURE(kernel.name);
    std::set<std::string> bounded, written;
    for (const FieldBound& bound : kernel.bounds.fields) {
      if (bound.field) bounded.insert(bound.field);
    }
    for_each_name(stage_fields(stage_of(kernel)).writes, [&](std::string_view name) { written.emplace(name); });
    written.erase("slot");  // generate's, which only numbers the paths
    CHECK(bounded == written);
  }
}

TEST_CASE("kernel fields: kernels read and write what kernels.h lists, and all of it") {
  std::vector<Plan> plans = verify::verification_plans();
  plans.push_back(make_plan(test::test_scene(), {}));  // connections and light paths, and corner normals
  for (Plan& plan : plans) {                           // so that no two materials are alike, and none reflects all
    for (size_t i = 0; i < plan.materials.size(); ++i)
      plan.materials[i].reflectance[0] = 0.9f / static_cast<float>(i + 1);
  }
  for (const verify::KernelCase& kernel : verify::kernel_cases()) {
    const std::string kernel_name = kernel.name;
    const KernelFields& listed = stage_fields(stage_of(kernel));
    std::set<std::string> read, written;
    for (const Plan& plan : plans) {
      // Connections and the environment are not tried where there are none, nor are lights where the environment is sampled.
      const auto of = [&](const char* what) { return kernel_name.find(what) != std::string::npos; };
      const bool sky = !plan.environment.empty();
      const bool connection = of("connect_sphere") || of("connection");
      if ((connection && (sky || plan.connected_spheres.empty())) || (of("environment") && !sky)) continue;
      if (of("sample_light") && sky) continue;
      if ((kernel_name == "take_lamps" || kernel_name == "emit" || kernel_name == "connect_camera") &&
          (sky || !has_light_paths(plan))) {
        continue;
      }
      if (kernel_name == "texture" && plan.textures.empty()) continue;
      Trial trial(plan, kernel);
      const Words before = trial.words(), after = trial.run("");
      for (size_t f = 0; f < kFields; ++f) {
        if (after[f] != before[f]) written.insert(kNames[f]);
        const Words changed = trial.run(kNames[f]);
        for (size_t g = 0; g < kFields; ++g) {
          // A field that the kernel leaves alone has been changed by the test.
          if (changed[g] != after[g] && (g != f || is_in(kNames[f], listed.writes))) read.insert(kNames[f]);
        }
      }
    }
    for (const std::string name : kNames) {
      CAPTURE(kernel_name);
      CAPTURE(name);
      // generate's batch is made from the paths' own pixels and samples, and it numbers them as the test does.
      if ((kernel_name == "generate" || kernel_name == "emit") && is_in(name, "pixel sample slot")) continue;
      CHECK((read.count(name) == 1) == is_in(name, listed.reads));
      CHECK((written.count(name) == 1) == is_in(name, listed.writes));
    }
  }
}

}  // namespace lanewise
