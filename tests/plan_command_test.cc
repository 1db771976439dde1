// `lanewise plan` from outside. LANEWISE_BINARY names the program, LANEWISE_SOURCE_DIR the checkout.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/explain.h"
#include "scenes/load.h"
#include "tests/program.h"
#include "tests/subprocess.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

using nlohmann::json;
using test::box;
using test::nothing_to_test;
using test::ProcessResult;
using test::program;
using test::TemporaryFolder;
using Arguments = std::vector<std::string>;

ProcessResult plan(const TemporaryFolder& folder, const Arguments& arguments) {
  Arguments all = {"plan"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return test::run_process(program(), all, folder.path());
}

void check_failure(const TemporaryFolder& folder, int exit_code, const Arguments& arguments,
                   const std::string& mentions) {
  const ProcessResult result = plan(folder, arguments);
  CAPTURE(result.err);
  CHECK(result.exit_code == exit_code);
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  CHECK(result.err.find(mentions) != std::string::npos);
  CHECK(result.out.empty());
}

TEST_CASE("plan command: a table for each topic, no line too long") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  for (const std::string& scene : {box(), std::string("builtin:dense:2000")}) {
    for (const char* accel : {"plan", "tree"}) {
      const ProcessResult result = plan(folder, {scene, "--accel", accel, "-m", "3"});
      CHECK(result.exit_code == 0);
      CHECK(result.err.empty());
      std::set<std::string> first_words;
      std::istringstream lines(result.out);
      for (std::string line; std::getline(lines, line);) {
        CAPTURE(line);
        CHECK(line.size() <= std::max<size_t>(118, scene.size() + 60));
        CHECK(!line.ends_with(' '));
        first_words.insert(line.substr(0, line.find(' ')));
      }
      for (const char* topic : {"stages", "light", "state", "geometry", "trees", "memory"}) {
        CHECK(first_words.contains(topic));
      }
      CHECK(result.out.find("-m 3: paths end before bounce 4") != std::string::npos);
    }
  }
}

TEST_CASE("plan command: the JSON holds the plan's decisions") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const ProcessResult result = plan(folder, {box(), "-q", "-t", "2", "--json", "plan.json"});
  CHECK(result.exit_code == 0);
  CHECK(result.out.empty());
  const json written = json::parse(test::read_text(folder.file("plan.json")));
  CHECK(written["scene"] == box());
  CHECK(written["command"].get<std::string>().starts_with("lanewise plan"));
  Settings settings;
  settings.threads = 2;
  const std::vector<Decision> expected = explain(make_plan(load_scene(box()), settings));
  REQUIRE(written["plan"].size() == expected.size());
  for (size_t i = 0; i < expected.size(); ++i) {
    const json& decision = written["plan"][i];
    CAPTURE(decision.dump());
    CHECK(decision["topic"] == expected[i].topic);
    CHECK(decision["subject"] == expected[i].subject);
    CHECK(decision["choice"] == expected[i].choice);
    CHECK(decision["reason"] == expected[i].reason);
    REQUIRE(decision["figures"].size() == expected[i].figures.size());
    for (const Figure& figure : expected[i].figures) {
      CHECK(decision["figures"][figure.name].get<double>() == doctest::Approx(figure.value));
    }
  }
}

TEST_CASE("plan command: wrong input gives one line and an exit code") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  check_failure(folder, 2, {}, "SCENE");
  check_failure(folder, 2, {box(), "--accel", "grid"}, "--accel");
  check_failure(folder, 2, {box(), "--spp", "0"}, "--spp");
  check_failure(folder, 2, {box(), "--json"}, "--json");
  check_failure(folder, 2, {box(), "--reference", "float"}, "--reference");
  check_failure(folder, 1, {folder.file("none.dae")}, "none.dae");
  check_failure(folder, 1, {box(), "--json", folder.file("no/folder.json")}, "no/folder.json");
  test::write_text(folder.file("scene.dae"), "<COLLADA");
  check_failure(folder, 1, {folder.file("scene.dae")}, "scene.dae");
  check_failure(folder, 2, {folder.file("scene.dae"), "--json", "./scene.dae"}, "would overwrite");
  CHECK(test::read_text(folder.file("scene.dae")) == "<COLLADA");
}

}  // namespace
}  // namespace lanewise
