// Folders that go away while a render draws what was to be written there.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/program.h"
#include "tests/running.h"
#include "tests/subprocess.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;
using test::ProcessResult;
using test::Running;
using test::TemporaryFolder;

// Where the error says that the file is kept.
std::string kept_as(const std::string& error, const std::string& file) {
  const std::string words = "it is kept as ";
  for (size_t at = error.find(words); at != std::string::npos; at = error.find(words, at + 1)) {
    const size_t begin = at + words.size();
    const std::string place = error.substr(begin, error.find_first_of(";\n", begin) - begin);
    if (place.ends_with("-" + file)) return place;
  }
  return {};
}

void into(const fs::path& temporary) { ::setenv("TMPDIR", temporary.c_str(), 1); }

ProcessResult lanewise(const TemporaryFolder& folder, const Arguments& arguments) {
  return test::run_process(test::program(), arguments, folder.path());
}

long lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

}  // namespace

TEST_CASE("vanishing: a render whose folders are gone keeps its files elsewhere, and says where") {
  if (test::nothing_to_test()) return;
  for (const bool renamed : {false, true}) {
    CAPTURE(renamed);
    const TemporaryFolder folder;
    for (const char* name : {"out", "kept", "elsewhere", "watch"}) fs::create_directory(folder.file(name));
    // No checkpoint is written before the end, which SIGTERM brings about.
    Running running(folder,
                    {"render", test::box(), "-r", "64", "48", "-q", "-s", "1000000000", "-f", "out/box.pfm", "--rate",
                     "out/rate.pfm", "--stats", "out/stats.json", "--checkpoint", "kept/c.exr", "--every", "1h"},
                    [&] { into(folder.file("elsewhere")); });
    running.wait_for("kept/c.exr.lock");
    Running::sleep(std::chrono::milliseconds(500));
    for (const char* name : {"out", "kept"}) {
      if (renamed) {
        fs::rename(folder.file(name), folder.file(std::string(name) + "-2"));
      } else {
        fs::remove_all(folder.file(name));
      }
    }
    CHECK(running.end(SIGTERM) == 1);
    const std::string err = test::read_text(folder.file("err"));
    CAPTURE(err);
    CHECK(lines(err) == 2);  // the warning of the checkpoint, and the error
    CHECK(err.find("out/box.pfm: cannot write: no folder out: it is kept as ") != std::string::npos);
    CHECK(err.find("kept/c.exr: cannot write: no folder kept: it is kept as ") != std::string::npos);
    const std::string film = kept_as(err, "c.exr"), picture = kept_as(err, "box.pfm");
    REQUIRE(fs::exists(film));
    REQUIRE(fs::exists(picture));
    CHECK(fs::exists(kept_as(err, "rate.pfm")));
    CHECK(fs::exists(kept_as(err, "stats.json")));
    CHECK(fs::path(film).parent_path() == folder.file("elsewhere"));

    // The film is whole: a render of one sample more than it has goes on from it, and what it has is the picture.
    CHECK(lanewise(folder, {"compare", picture, film}).exit_code == 0);
    const ProcessResult same = lanewise(folder, {"compare", picture, film, "--json"});
    CHECK(same.out.find("\"differing\": 0.0") != std::string::npos);
  }
}

TEST_CASE("vanishing: a part that cannot be written is kept elsewhere, to be merged") {
  if (test::nothing_to_test()) return;
  const TemporaryFolder folder;
  fs::create_directory(folder.file("out"));
  fs::create_directory(folder.file("elsewhere"));
  const Arguments render = {"render", test::box(), "-r", "64", "48", "-q"};
  const auto with = [&](const Arguments& more) {
    Arguments all = render;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  Running running(folder, with({"--samples", "0:800", "-f", "out/part.exr", "--checkpoint", "c.exr"}),
                  [&] { into(folder.file("elsewhere")); });
  running.wait_for("c.exr.lock");
  fs::remove_all(folder.file("out"));
  CHECK(running.wait() == 1);
  const std::string err = test::read_text(folder.file("err"));
  CAPTURE(err);
  const std::string part = kept_as(err, "part.exr");
  REQUIRE(fs::exists(part));
  CHECK(lanewise(folder, {"merge", part, "-q", "-f", "got.pfm"}).exit_code == 0);
  CHECK(lanewise(folder, with({"-s", "800", "-f", "want.pfm"})).exit_code == 0);
  const bool equal = test::read_text(folder.file("got.pfm")) == test::read_text(folder.file("want.pfm"));
  CHECK(equal);
}

TEST_CASE("vanishing: where the folder for temporary files is none, it is /tmp; the other files are written") {
  if (test::nothing_to_test()) return;
  const TemporaryFolder folder;
  fs::create_directory(folder.file("out"));
  Running running(folder,
                  {"render", test::box(), "-r", "64", "48", "-q", "-s", "800", "-f", "out/box.pfm", "--stats",
                   "stats.json", "--checkpoint", "c.exr"},
                  [] { into("/nowhere/at/all"); });
  running.wait_for("c.exr.lock");
  fs::remove_all(folder.file("out"));
  const int exit_code = running.wait();
  const std::string err = test::read_text(folder.file("err"));
  CAPTURE(err);
  CHECK(exit_code == 1);
  CHECK(lines(err) == 1);
  CHECK(fs::exists(folder.file("stats.json")));
  CHECK(fs::exists(folder.file("c.exr")));
  // TMPDIR leads nowhere, so the picture is in /tmp.
  const std::string picture = kept_as(err, "box.pfm");
  CHECK(picture.starts_with("/tmp/"));
  CHECK(fs::remove(picture));
}

}  // namespace lanewise
