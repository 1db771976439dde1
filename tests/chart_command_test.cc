// `lanewise chart` from outside, and its page in a browser. Needs python3-matplotlib, and chromium for the page (tools/setup
// charts); without them the tests say that they are skipped. No check hangs on how long anything takes.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/program.h"
#include "tests/subprocess.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

using nlohmann::json;
using test::box;
using test::ProcessResult;
using test::read_text;
using test::TemporaryFolder;
using Arguments = std::vector<std::string>;

const std::string kPython = "/usr/bin/python3";

std::string source(const std::string& path) { return test::environment("LANEWISE_SOURCE_DIR", ".") + "/" + path; }

bool cannot_chart() {
  if (test::nothing_to_test()) return true;
  if (std::filesystem::exists("/usr/lib/python3/dist-packages/matplotlib")) return false;
  MESSAGE("skipped: no python3-matplotlib");
  return true;
}

bool cannot_browse() {
  if (std::filesystem::exists("/usr/bin/chromium")) return false;
  MESSAGE("skipped: no chromium");
  return true;
}

ProcessResult chart(const TemporaryFolder& folder, const Arguments& arguments) {
  Arguments all = {"chart", "--cache", "cache", "--out", "out"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return test::run_process(test::program(), all, folder.path());
}

// Two configurations, three sample counts, two seeds.
ProcessResult chart_small(const TemporaryFolder& folder) {
  const ProcessResult result =
      chart(folder, {box(), "--config", "one:", "--config", "two lights: -l 2", "--resolution", "24", "18", "--samples",
                     "1", "4", "16", "--seeds", "2", "--reference", "256"});
  CAPTURE(result.err);
  REQUIRE(result.exit_code == 0);
  return result;
}

ProcessResult look_at(const TemporaryFolder& folder, const std::string& page, size_t charts) {
  return test::run_process(kPython, {source("tests/page_check.py"), page, "--charts", std::to_string(charts)},
                           folder.path());
}

TEST_CASE("chart command: points, figures and a page that a browser shows as it should") {
  if (cannot_chart()) return;
  const TemporaryFolder folder;
  const ProcessResult first = chart_small(folder);
  CHECK(first.out.find("two lights, 16 samples") != std::string::npos);

  const std::string points = read_text(folder.file("out/chart.csv"));
  CHECK(points.starts_with("scene,renderer,samples,seed,seconds,mrse,flip\n"));
  CHECK(std::count(points.begin(), points.end(), '\n') == 1 + 2 * 3 * 2);
  const json figures = json::parse(read_text(folder.file("out/chart.json")));
  CHECK(figures["command"].get<std::string>().starts_with("lanewise chart cornell_spheres.dae --config one: "));
  const json& scene = figures["scenes"]["cornell_spheres"];
  CHECK(scene["reference"]["samples"] == 256);
  CHECK(scene["reference"]["mrse"].get<double>() > 0);
  for (const json& renderer : scene["renderers"]) {
    CHECK(renderer["samples"] == json({1, 4, 16}));
    CHECK(renderer["mrse"][0].get<double>() > renderer["mrse"][2].get<double>());
  }

  const std::string page = read_text(folder.file("out/index.html"));
  for (const char* text :
       {"lanewise chart cornell_spheres.dae", "two lights", "Pareto front", "What the same time gives"}) {
    CAPTURE(text);
    CHECK(page.find(text) != std::string::npos);
  }
  // All was kept: the same command renders nothing again.
  CHECK(chart_small(folder).out.find(" 0 renders") != std::string::npos);
  CHECK(read_text(folder.file("out/index.html")) == page);

  if (cannot_browse()) return;
  size_t charts = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.file("out"))) {
    charts += entry.path().extension() == ".svg";
  }
  CHECK(charts >= 1);
  const ProcessResult seen = look_at(folder, "out/index.html", charts);
  CAPTURE(seen.out);
  CAPTURE(seen.err);
  CHECK(seen.exit_code == 0);
}

TEST_CASE("chart command: what is wrong with a page is found") {
  if (cannot_chart() || cannot_browse()) return;
  const TemporaryFolder folder;
  test::write_text(folder.file("broken.html"), R"(<!DOCTYPE html><html><body>
<script>console.error('a script failed'); missing_function();</script>
<p style="position: absolute; top: 300px; left: 10px">over</p><p style="position: absolute; top: 300px; left: 12px">under</p>
<div style="width: 700px">wide</div>
<figure class="chart"><svg width="200" height="100"><text x="10" y="50">label</text><text x="12" y="52">on label</text>
<text x="180" y="20">far out</text></svg></figure>
<figure class="chart"><svg width="200" height="0"></svg></figure>
<img src="nowhere.png" style="width: 60px; height: 60px"></body></html>)");
  const ProcessResult seen = look_at(folder, "broken.html", 3);
  CAPTURE(seen.out);
  CAPTURE(seen.err);
  CHECK(seen.exit_code == 1);
  for (const char* complaint :
       {"1280 pixels: 2 charts, not 3", "console: a script failed", "missing_function is not defined",
        "\"over\" overlaps", "400 pixels: the page is wider", "\"wide\" sticks out",
        "\"label\" overlaps \"on label\" in its chart", "\"far out\" sticks out of its chart", "is only 200 x 0 pixels",
        "has no picture", "asks for nowhere.png"}) {
    CAPTURE(complaint);
    CHECK(seen.out.find(complaint) != std::string::npos);
  }
  CHECK(seen.out.find("1280 pixels: the page is wider") == std::string::npos);
}

TEST_CASE("chart command: slopes, times to an error and its bounds are what is known") {
  if (cannot_chart()) return;
  const TemporaryFolder folder;
  ::setenv("LANEWISE_BINARY", test::program().c_str(), 1);
  const ProcessResult result =
      test::run_process(kPython, {source("tests/chart_measures_check.py"), source("perf")}, folder.path());
  CAPTURE(result.err);
  CHECK(result.exit_code == 0);
}

TEST_CASE("chart command: what it cannot do is said in one line, before any work") {
  if (cannot_chart()) return;
  const TemporaryFolder folder;
  test::write_text(folder.file("list.json"), "[1, 2]");
  const auto check_failure = [&](int exit_code, const Arguments& arguments, const std::string& says) {
    const ProcessResult result = chart(folder, arguments);
    CAPTURE(result.err);
    CHECK(result.exit_code == exit_code);
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    CHECK(result.err.find(says) != std::string::npos);
    CHECK(!std::filesystem::exists(folder.file("out/index.html")));
  };
  check_failure(1, {"missing.dae"}, "missing.dae: no such file");
  check_failure(2, {box(), "--samples", "0"}, "--samples: '0' is not a whole number above 0");
  check_failure(2, {box(), "--config", "x: -s 4"}, "-s is for lanewise chart to choose");
  check_failure(2, {box(), "--config", "x: --isa none"}, "--config 'x: --isa none': --isa: 'none' is none of");
  check_failure(1, {box(), "--configs", "list.json"}, "list.json: is not an object of names and flags");
}

}  // namespace
}  // namespace lanewise
