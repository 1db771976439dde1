// `cmake --install` of the build that the program lies in, and what is installed: whole, and without the checkout. And what
// --version tells.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "tests/program.h"
#include "tests/subprocess.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

namespace fs = std::filesystem;
using test::nothing_to_test;
using test::ProcessResult;
using test::program;
using test::read_text;
using test::TemporaryFolder;

const std::string kPython = "/usr/bin/python3", kCMake = "/usr/bin/cmake";

bool cannot_install() {
  if (nothing_to_test()) return true;
  if (fs::exists(kCMake) && fs::exists(fs::path(program()).parent_path() / "cmake_install.cmake")) return false;
  MESSAGE("skipped: no " << kCMake << ", or no build around the program");
  return true;
}

bool cannot_chart() {
  if (fs::exists("/usr/lib/python3/dist-packages/matplotlib") && fs::exists("/usr/lib/python3/dist-packages/PIL")) {
    return false;
  }
  MESSAGE("skipped: no python3-matplotlib or no python3-pil");
  return true;
}

// To `prefix` in the folder; gives the program's path there.
std::string install(const TemporaryFolder& folder) {
  const std::string build = fs::path(program()).parent_path().string();
  const ProcessResult result =
      test::run_process(kCMake, {"--install", build, "--prefix", folder.file("prefix")}, folder.path());
  CAPTURE(result.err);
  REQUIRE(result.exit_code == 0);
  return folder.file("prefix/bin/lanewise");
}

TEST_CASE("install: the program, scenes, scripts, pages and licences, and nothing else") {
  if (cannot_install()) return;
  const TemporaryFolder folder;
  const std::string installed = install(folder);
  const std::regex wanted(
      "bin/lanewise"
      "|share/lanewise/scenes/\\w+\\.(dae|hdr|png)"
      "|share/lanewise/perf/(chart|replay)(_\\w+)?\\.py"
      "|share/lanewise/perf/(command|kept|lanewise|page|picture_error|study|svg_text|peers/collada|peers/peer)\\.py"
      "|share/lanewise/perf/replay/\\w+\\.json"
      "|share/man/man1/lanewise\\.1(\\.gz)?"
      "|share/bash-completion/completions/lanewise|share/zsh/vendor-completions/_lanewise"
      "|share/fish/vendor_completions\\.d/lanewise\\.fish"
      "|share/doc/lanewise/copyright");
  size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder.file("prefix"))) {
    if (!entry.is_regular_file()) continue;
    const std::string path = fs::relative(entry.path(), folder.file("prefix")).string();
    CAPTURE(path);
    const bool is_wanted = std::regex_match(path, wanted);
    CHECK(is_wanted);
    ++files;
  }
  CHECK(files >= 40);
  CHECK(read_text(folder.file("prefix/share/doc/lanewise/copyright")).starts_with("MIT License"));
  CHECK(read_text(folder.file("prefix/share/bash-completion/completions/lanewise")).find("complete -F") !=
        std::string::npos);
#ifdef NDEBUG
  const bool names_checkout =
      read_text(installed).find(test::environment("LANEWISE_SOURCE_DIR", ".")) != std::string::npos;
  CHECK(!names_checkout);
#endif
  const std::string sky = folder.file("prefix/share/lanewise/scenes/sky.hdr");
  for (const auto& entry : fs::directory_iterator(folder.file("prefix/share/lanewise/scenes"))) {
    if (entry.path().extension() != ".dae") continue;
    CAPTURE(entry.path().filename().string());
    const ProcessResult rendered = test::run_process(
        installed, {"render", entry.path().string(), "-e", sky, "-r", "24", "18", "-s", "1", "-q", "-f", "a.png"},
        folder.path());
    CHECK(rendered.exit_code == 0);
    CHECK(rendered.out.empty());
    CHECK(rendered.err.empty());
    // With its textures: it is what it is in the checkout.
    const auto told = [&](const fs::path& scenes) {
      return test::run_process(installed, {"info", entry.path().filename().string(), "--json"}, scenes).out;
    };
    CHECK(told(entry.path().parent_path()) == told(test::environment("LANEWISE_SOURCE_DIR", ".") + "/scenes"));
  }
}

TEST_CASE("install: chart and replay are the scripts that are installed beside the program") {
  if (cannot_install() || !fs::exists(kPython)) return;
  const TemporaryFolder folder;
  const std::string installed = install(folder);
  const fs::path perf = folder.file("prefix/share/lanewise/perf");
  if (!cannot_chart()) {
    // Every module finds all that it imports.
    const std::string script =
        "import pathlib, sys\nsys.path.insert(0, sys.argv[1])\n"
        "for path in pathlib.Path(sys.argv[1]).glob('*.py'): __import__(path.stem)\n";
    const ProcessResult imported = test::run_process(kPython, {"-B", "-c", script, perf.string()}, folder.path());
    CAPTURE(imported.err);
    CHECK(imported.exit_code == 0);
    ::unsetenv("PYTHONDONTWRITEBYTECODE");
    for (const char* command : {"chart", "replay"}) {
      const ProcessResult help = test::run_process(installed, {command, "--help"}, folder.path());
      CHECK(help.exit_code == 0);
      CHECK(help.out.find(std::string("usage: lanewise ") + command) != std::string::npos);
    }
    CHECK(!fs::exists(perf / "__pycache__"));
  }
  for (const char* command : {"chart", "replay"}) {
    test::write_text((perf / (std::string(command) + ".py")).string(),
                     "import os, sys\nprint('own', os.environ['LANEWISE_BINARY'], *sys.argv[1:])\n");
    const ProcessResult own = test::run_process(installed, {command, "--a", "b"}, folder.path());
    CHECK(own.out == "own " + installed + " --a b\n");
    fs::remove(perf / (std::string(command) + ".py"));
    const ProcessResult none = test::run_process(installed, {command}, folder.path());
    CHECK(none.exit_code == 1);
    CHECK(none.err.find(std::string("share/lanewise/perf/") + command + ".py: is not there") != std::string::npos);
    CHECK(std::count(none.err.begin(), none.err.end(), '\n') == 1);
  }
}

TEST_CASE("version: of the project, how it was built, the instruction set that renders take, libraries") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const ProcessResult told = test::run_process(program(), {"--version"}, folder.path());
  CHECK(told.exit_code == 0);
  std::smatch match;
  const std::string project = read_text(test::environment("LANEWISE_SOURCE_DIR", ".") + "/CMakeLists.txt");
  REQUIRE(std::regex_search(project, match, std::regex(R"(project\(lanewise VERSION (\S+))")));
  CHECK(told.out.starts_with("lanewise " + match.str(1) + "\n"));

  const std::regex built(R"(\nbuilt by (GCC|Clang) \d+\.\d+\S*.*, \w+)");
  CHECK(std::regex_search(told.out, built));
  for (const char* name :
       {"Highway", "oneTBB", "OpenEXR", "Assimp", "pugixml", "CLI11", "nlohmann-json", "GLM", "stb_image"}) {
    CAPTURE(name);
    const std::regex library("libraries:.* " + std::string(name) + R"( \d+\.\d+)");
    CHECK(std::regex_search(told.out, library));
  }

  REQUIRE(std::regex_search(told.out, match, std::regex(R"(\ninstruction sets: (scalar\b[\w, ]*); here (\w+)\n)")));
  CHECK(match.str(1).find(match.str(2)) != std::string::npos);
  const ProcessResult rendered = test::run_process(
      program(), {"render", test::box(), "-r", "24", "18", "-s", "1", "-q", "-f", "a.png", "--stats", "stats.json"},
      folder.path());
  REQUIRE(rendered.exit_code == 0);
  CHECK(nlohmann::json::parse(read_text(folder.file("stats.json")))["isa"] == match.str(2));
}

}  // namespace
}  // namespace lanewise
