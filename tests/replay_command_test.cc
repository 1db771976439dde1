// `lanewise replay` from outside, and its page in a browser. Needs python3-matplotlib and python3-pil, and chromium for the
// page (tools/setup charts); without them the tests say that they are skipped. No check hangs on how long anything takes.
#include <doctest/doctest.h>

#include <algorithm>
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
using test::ProcessResult;
using test::read_text;
using test::TemporaryFolder;
using Arguments = std::vector<std::string>;

const std::string kPython = "/usr/bin/python3";

#ifdef NDEBUG
constexpr bool kClaims = true;
#else
constexpr bool kClaims = false;  // slow builds have enough in the pictures
#endif

// Three pictures of a shipped scene; that of the other scene is nowhere.
const char* const kTopic = R"({
  "title": "Spheres & a box", "about": "What is there.", "scene": "CBspheres", "stand_in": "cornell_spheres",
  "sheets": [
    {"title": "Depth", "flags": "-l 2", "sweep": ["-m 0", "-m 1"], "shows": {"-m 0": "The light <alone>."}, "animation": 500},
    {"title": "Rate", "flags": "-a 4 0.5", "samples": [16], "full_samples": [32], "rate": true},
    {"title": "Missing", "scene": "CBnone"}
  ]
})";

bool cannot_replay() {
  if (test::nothing_to_test()) return true;
  const std::filesystem::path packages = "/usr/lib/python3/dist-packages";
  if (std::filesystem::exists(packages / "matplotlib") && std::filesystem::exists(packages / "PIL")) return false;
  MESSAGE("skipped: no python3-matplotlib or no python3-pil");
  return true;
}

ProcessResult replay(const TemporaryFolder& folder, const Arguments& arguments) {
  std::filesystem::create_directory(folder.file("scenes"));  // so that the course's are not there
  Arguments all = {"replay", "--cache", "cache", "--out", "out", "--scenes", "scenes", "-r", "48", "36"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return test::run_process(test::program(), all, folder.path());
}

ProcessResult look_at(const TemporaryFolder& folder, size_t charts) {
  const std::string check = test::environment("LANEWISE_SOURCE_DIR", ".") + "/tests/page_check.py";
  return test::run_process(kPython, {check, "out/index.html", "--charts", std::to_string(charts)}, folder.path());
}

TEST_CASE("replay command: pictures and captions, and a page; it goes on where it was") {
  if (cannot_replay()) return;
  const TemporaryFolder folder;
  test::write_text(folder.file("topic.json"), kTopic);
  const ProcessResult first = replay(folder, {"topic.json"});
  CAPTURE(first.err);
  REQUIRE(first.exit_code == 0);
  CHECK(first.out.find("3 of 3: lanewise render cornell_spheres.dae ") != std::string::npos);
  CHECK(first.out.find("3 pictures, 0 claims, 3 renders") != std::string::npos);

  const json figures = json::parse(read_text(folder.file("out/replay.json")));
  REQUIRE(figures["pictures"].size() == 3);
  CHECK(figures["pictures"][1]["command"] ==
        "lanewise render cornell_spheres.dae -r 48 36 -l 2 -m 1 -s 64 -f cornell-spheres-l-2-m-1-s-64.png");
  for (const json& picture : figures["pictures"]) {
    CHECK(picture["rays"].get<double>() > 0);
    CHECK(picture["seconds"].get<double>() > 0);
  }
  CHECK(figures["pictures"][1]["estimated_mrse"]["value"].get<double>() > 0);
  CHECK(figures["pictures"][2]["samples_per_pixel"].get<double>() <= 16);
  CHECK(figures["notes"][0] == "\"Missing\" is left out: CBnone.dae is not there.");
  for (const char* file : {"contact-sheet.jpg", "pictures/cornell-spheres-l-2-m-0-s-64.png",
                           "pictures/cornell-spheres-a-4-0.5-s-16-rate.png"}) {
    CAPTURE(file);
    CHECK(std::filesystem::file_size(folder.file(std::string("out/") + file)) > 100);
  }
  const std::string page = read_text(folder.file("out/index.html"));
  for (const char* text : {"Spheres &amp; a box", "The light &lt;alone&gt;.", "lanewise render cornell_spheres.dae",
                           "million rays", "noise ", "An animation"}) {
    CAPTURE(text);
    CHECK(page.find(text) != std::string::npos);
  }
  CHECK(page.find(folder.path().string()) == std::string::npos);  // where things lie is nobody's business

  // One picture is lost: it alone is rendered again, and looks as it did. Its time is its own.
  const std::string before = read_text(folder.file("out/pictures/cornell-spheres-l-2-m-1-s-64.png"));
  for (const auto& entry : std::filesystem::directory_iterator(folder.file("cache"))) {
    if (entry.path().extension() != ".json") continue;
    if (json::parse(read_text(entry.path().string()))["paths_by_length"].size() != 2) continue;
    std::filesystem::remove(entry.path());
    break;
  }
  CHECK(replay(folder, {"topic.json"}).out.find("3 pictures, 0 claims, 1 renders") != std::string::npos);
  CHECK(read_text(folder.file("out/pictures/cornell-spheres-l-2-m-1-s-64.png")) == before);
}

TEST_CASE(
    "replay command: the shipped files and all claims, without the course's scenes, and how a browser shows them") {
  if (cannot_replay()) return;
  const TemporaryFolder folder;
  Arguments arguments = {"--samples", "1", "-r", "24", "18"};
  if (!kClaims) arguments.push_back("--no-claims");
  const ProcessResult result = replay(folder, arguments);
  CAPTURE(result.err);
  REQUIRE(result.exit_code == 0);
  const json figures = json::parse(read_text(folder.file("out/replay.json")));
  CHECK(figures["pictures"].size() >= 30);
  CHECK(figures["notes"].size() >= 1);
  CHECK(figures["claims"].size() == (kClaims ? 6 : 0));
  for (const json& claim : figures["claims"]) {
    CAPTURE(claim["quote"]);
    const auto verdict = claim["verdict"].get<std::string>();
    CHECK((verdict.starts_with("Holds") || verdict.starts_with("Does not hold")));
    CHECK(claim["rows"].size() >= 2);
    for (const json& row : claim["rows"]) CHECK(row.size() == claim["head"].size());
    CHECK(claim["commands"][0].get<std::string>().starts_with("lanewise render cornell_"));
  }
  CHECK(read_text(folder.file("out/index.html")).find("render CB") == std::string::npos);

  if (!std::filesystem::exists("/usr/bin/chromium")) {
    MESSAGE("skipped: no chromium");
    return;
  }
  const ProcessResult seen = look_at(folder, kClaims ? 3 : 0);
  CAPTURE(seen.out);
  CAPTURE(seen.err);
  CHECK(seen.exit_code == 0);
}

TEST_CASE("replay command: what it cannot do is said in one line, before any work") {
  if (cannot_replay()) return;
  const TemporaryFolder folder;
  const auto check_failure = [&](int exit_code, const Arguments& arguments, const std::string& says) {
    const ProcessResult result = replay(folder, arguments);
    CAPTURE(result.err);
    CHECK(result.exit_code == exit_code);
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    CHECK(result.err.find(says) != std::string::npos);
    CHECK(!std::filesystem::exists(folder.file("out")));
  };
  const auto check_file = [&](int exit_code, const std::string& text, const std::string& says) {
    test::write_text(folder.file("bad.json"), text);
    check_failure(exit_code, {"bad.json"}, "bad.json: " + says);
  };
  const auto sheet = [](const std::string& more) {
    return R"({"title": "a", "scene": "x", "stand_in": "cornell_spheres", "sheets": [{"title": "b", )" + more + "}]}";
  };
  check_failure(2, {"--samples", "0"}, "--samples: '0' is not a whole number above 0");
  check_file(1, R"({"title": "a", "sheet": []})", "the file has an unknown member \"sheet\"");
  check_file(1, sheet(R"("sweep": "-m 0")"), "\"sweep\" of a sheet is not a list of texts");
  check_file(1, sheet(R"("flags": "-s 4")"), "\"b\": -s is for lanewise replay to choose");
  check_file(2, sheet(R"("sweep": ["--bounces 4"])"), "\"b\": --bounces 4: The following");
  check_file(1, sheet(R"("sweep": ["-m 1"], "shows": {"-m 2": "c"})"), "\"b\": \"shows\" names \"-m 2\"");
}

}  // namespace
}  // namespace lanewise
