// `lanewise profile` from outside. LANEWISE_BINARY names the program, LANEWISE_SOURCE_DIR the checkout. No check hangs on how
// long anything takes.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

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
using test::read_text;
using test::TemporaryFolder;
using Arguments = std::vector<std::string>;

ProcessResult profile(const TemporaryFolder& folder, const Arguments& arguments) {
  Arguments all = {"profile"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return test::run_process(program(), all, folder.path());
}

// A moment's profile, with more flags.
ProcessResult profile_small(const TemporaryFolder& folder, const Arguments& more, uint32_t repeat = 2) {
  Arguments all = {box(), "-r", "24", "18", "-s", "4", "-m", "3", "-t", "2", "--repeat", std::to_string(repeat)};
  all.insert(all.end(), more.begin(), more.end());
  const ProcessResult result = profile(folder, all);
  CAPTURE(result.err);
  REQUIRE(result.exit_code == 0);
  return result;
}

void check_failure(const TemporaryFolder& folder, int exit_code, const Arguments& arguments,
                   const std::string& mentions) {
  const ProcessResult result = profile(folder, arguments);
  CAPTURE(result.err);
  CHECK(result.exit_code == exit_code);
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  CHECK(result.err.find(mentions) != std::string::npos);
  CHECK(result.out.empty());
}

double sum_of(const json& list, const char* key) {
  double sum = 0;
  for (const json& item : list) sum += item[key].get<double>();
  return sum;
}

const json& stage_of(const json& report, const std::string& name) {
  return *std::find_if(report["stages"].begin(), report["stages"].end(),
                       [&](const json& stage) { return stage["name"] == name; });
}

TEST_CASE("profile command: the JSON adds up") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  profile_small(folder, {"--json", "p.json", "-q"}, 3);
  const std::string text = read_text(folder.file("p.json"));
  CHECK(text.find("null") == std::string::npos);  // how JSON writes NaN
  const json report = json::parse(text);
  CHECK(report["scene"] == box());
  CHECK(report["command"].get<std::string>().starts_with("lanewise profile "));
  CHECK(report["cpu"].is_string());
  CHECK(report["samples"] == 24 * 18 * 4);
  CHECK(report["settings"]["--spp"] == "4");
  CHECK(report["settings"]["--resolution"] == "24 18");
  CHECK(report["settings"]["--light-samples"] == "1");  // the default
  for (const char* times : {"seconds", "seconds_unclocked", "cpu_seconds", "cpu_seconds_unclocked"}) {
    CHECK(report[times].size() == 3);
  }
  CHECK(sum_of(report["stages"], "share") == doctest::Approx(1));
  CHECK(sum_of(report["stages"], "seconds") == doctest::Approx(report["stage_seconds"].get<double>()));
  CHECK(report["overhead"]["by_count"].get<double>() > 0);
  for (const json& stage : report["stages"]) {
    CAPTURE(stage.dump());
    for (const char* sum : {"calls", "paths", "lanes", "bytes", "seconds", "share"}) {
      CHECK(sum_of(stage["bounces"], sum) == doctest::Approx(stage[sum].get<double>()));
    }
    CHECK(stage["ns_per_path_runs"].size() == 3);
    CHECK(stage["live_lanes"].get<double>() > 0);
    CHECK(stage["live_lanes"].get<double>() <= 1);
    const double words = stage["words_read"].get<double>() + stage["words_written"].get<double>();
    if (stage["name"] == "sort") {
      CHECK(stage["bytes"].get<double>() < 4 * words * stage["lanes"].get<double>());  // finished paths move less
    } else {
      CHECK(stage["bytes"] == 4 * words * stage["lanes"].get<double>());
    }
    const auto lengths = stage["paths_per_call"].get<std::vector<uint32_t>>();
    CHECK(lengths.size() == 5);
    CHECK(std::is_sorted(lengths.begin(), lengths.end()));
    const bool traces =
        stage["name"] == "intersect" || stage["name"] == "occlude" || stage["name"] == "occlude_connection";
    CHECK(stage.contains("rays_per_second") == traces);
  }
  const json& intersect = stage_of(report, "intersect");
  CHECK(intersect["bounces"].size() == 3 + 1);
  CHECK(intersect["rays"] == report["rays"]["camera"].get<uint64_t>() + report["rays"]["light"].get<uint64_t>() +
                                 report["rays"]["bounce"].get<uint64_t>());
  const uint64_t straight = stage_of(report, "occlude")["rays"],
                 by_spheres = stage_of(report, "occlude_connection")["rays"];
  CHECK(straight + by_spheres == report["rays"]["shadow"]);
  REQUIRE(report["scaling"].size() == 2);
  CHECK(report["scaling"][0]["threads"] == 1);
  CHECK(report["scaling"][1]["threads"] == 2);
  CHECK(report["scaling"][0]["speedup"] == 1);
  CHECK(report["scaling"][1]["seconds"].size() == 3);
}

TEST_CASE("profile command: a trace of stages within waves, of bounded size") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const ProcessResult result =
      profile_small(folder, {"--trace", "t.json", "--trace-waves", "2", "--wave", "64", "--no-scaling", "-q"});
  CHECK(result.out.empty());
  const json trace = json::parse(read_text(folder.file("t.json")));
  CHECK(trace["otherData"]["command"].get<std::string>().find("--trace-waves 2") != std::string::npos);
  size_t waves = 0;
  for (const json& event : trace["traceEvents"]) {
    if (event["ph"] == "M") continue;
    CHECK(event["ph"] == "X");
    CHECK(event["ts"].get<double>() >= 0);
    CHECK(event["dur"].get<double>() >= 0);
    CHECK(event["args"]["paths"].get<int>() > 0);
    CHECK(event["args"]["paths"].get<int>() <= 64);
    waves += event["name"] == "wave";
    if (event["cat"] == "stage") CHECK(event["args"]["bounce"].get<int>() <= 3);
  }
  CHECK(waves >= 2);
  CHECK(waves <= 4);  // of two threads
}

TEST_CASE("profile command: a page that needs no other file") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  profile_small(folder, {"--html", "p.html", "-q"});
  const std::string page = read_text(folder.file("p.html"));
  CHECK(page.starts_with("<!DOCTYPE html>"));
  for (const char* text : {"--html p.html", "<svg", "ns of thread time a sample", "% of lanes", "paths in a call",
                           "GB/s", "million rays/s", "speedup", "intersect", "shade_glass"}) {
    CAPTURE(text);
    CHECK(page.find(text) != std::string::npos);
  }
  for (const char* outside : {"http:", "https:", "src=", "href=", "url(", "@import", "<script", "nan", "inf'"}) {
    CAPTURE(outside);
    CHECK(page.find(outside) == std::string::npos);
  }
}

TEST_CASE("profile command: tables that fit a terminal") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const ProcessResult result = profile_small(folder, {});
  for (const char* text :
       {"intersect", "ns/path", "live %", "paths in a call", "GB/s", "Mrays/s", "bounce", "speedup"}) {
    CAPTURE(text);
    CHECK(result.out.find(text) != std::string::npos);
  }
  std::istringstream tables(result.out.substr(result.out.find("\n\n")));  // what is above them names files
  for (std::string line; std::getline(tables, line);) {
    CAPTURE(line);
    CHECK(line.size() <= 118);
  }
  CHECK(profile_small(folder, {"--no-scaling"}).out.find("speedup") == std::string::npos);
}

TEST_CASE("profile command: nothing has changed between a profile and itself") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  profile_small(folder, {"--json", "old.json", "--no-scaling", "-q"}, 6);
  const ProcessResult same =
      profile(folder, {"old.json", "--compare", "old.json", "--json", "again.json", "--html", "again.html"});
  CHECK(same.exit_code == 0);
  CHECK(same.out.find("No change beyond the noise.") != std::string::npos);
  CHECK(same.out.find("differs") == std::string::npos);
  CHECK(read_text(folder.file("again.json")) == read_text(folder.file("old.json")));

  json changed = json::parse(read_text(folder.file("old.json")));
  changed["settings"]["--spp"] = "16";
  changed["isa"] = "neon";
  changed["calm_waves"] = 1;
  for (json& stage : changed["stages"]) {
    const double factor = stage["name"] == "sort" ? 0.5 : stage["name"] == "surface" ? 3.0 : 1.0;
    double spread = 1;  // the runs' own noise would hide a change as it should
    for (json& ns : stage["ns_per_path_runs"]) ns = factor * 10 * (spread += 0.001);
  }
  test::write_text(folder.file("changed.json"), changed.dump());
  for (json& stage : changed["stages"]) {
    double spread = 1;
    for (json& ns : stage["ns_per_path_runs"]) ns = 10 * (spread += 0.001);
  }
  test::write_text(folder.file("even.json"), changed.dump());
  const ProcessResult other = profile(folder, {"changed.json", "-q", "--compare", "even.json"});
  CAPTURE(other.out);
  CHECK(other.out.find("differs") == std::string::npos);
  const auto line_of = [](const std::string& text, const std::string& stage) {
    const size_t at = text.find("\n" + stage + " ");
    return text.substr(at, text.find('\n', at + 1) - at);
  };
  CHECK(line_of(other.out, "sort").ends_with("faster"));
  CHECK(line_of(other.out, "surface").ends_with("SLOWER"));
  CHECK(line_of(other.out, "intersect").ends_with("1.000"));
  CHECK(other.out.find("2 beyond the noise") != std::string::npos);
  const ProcessResult flags = profile(folder, {"changed.json", "-q", "--compare", "old.json"});
  CHECK(flags.out.find("--spp differs: 4, now 16") != std::string::npos);
  CHECK(flags.out.find("instruction set differs") != std::string::npos);
}

TEST_CASE("profile command: what it cannot do is said in one line, before any work") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const std::string scene = box();
  test::write_text(folder.file("text.json"), "no JSON");
  test::write_text(folder.file("other.json"), R"({"a": 1})");
  test::write_text(folder.file("list.json"), "[1, 2]");
  profile_small(folder, {"--json", "good.json", "--no-scaling", "-q"});
  const json good = json::parse(read_text(folder.file("good.json")));
  json part = good;
  part.erase("stages");
  test::write_text(folder.file("part.json"), part.dump());
  part = good;
  part["seconds"][0] = "long";
  test::write_text(folder.file("typed.json"), part.dump());
  part = good;
  part["seconds"].push_back(1);
  test::write_text(folder.file("runs.json"), part.dump());
  part = good;
  part["format_version"] = 1000;
  test::write_text(folder.file("future.json"), part.dump());
  for (const char* name : {"missing.json", "text.json", "other.json", "list.json", "part.json", "typed.json",
                           "runs.json", "future.json"}) {
    check_failure(folder, 1, {scene, "--compare", name}, name);
    check_failure(folder, 1, {name}, name);
  }
  check_failure(folder, 1, {scene, "--json", "none/p.json"}, "none/p.json");
  check_failure(folder, 1, {"missing.dae"}, "missing.dae");
  check_failure(folder, 2, {}, "SCENE");
  check_failure(folder, 2, {scene, "--repeat", "0"}, "--repeat");
  check_failure(folder, 2, {scene, "--json", "a", "--html", "a"}, "--html: would overwrite a");
  check_failure(folder, 2, {scene, "--html", "a", "--trace", "./a"}, "--trace: would overwrite a");
  check_failure(folder, 2, {scene, "--json", scene}, "--json: would overwrite");
  check_failure(folder, 2, {scene, "--compare", "good.json", "--json", "good.json"},
                "--json: would overwrite good.json");
  check_failure(folder, 2, {"good.json", "--html", "good.json"}, "--html: would overwrite good.json");
  check_failure(folder, 2, {"good.json", "-s", "16"}, "--spp: nothing is rendered");
  check_failure(folder, 2, {"good.json", "--trace", "t"}, "--trace: nothing is rendered");
  check_failure(folder, 2, {scene, "--reference", "float"}, "--reference");
  check_failure(folder, 2, {scene, "-e", "sky.png"}, "sky.png: an environment map holds radiance");
  CHECK(json::parse(read_text(folder.file("good.json"))) == good);
}

}  // namespace
}  // namespace lanewise
