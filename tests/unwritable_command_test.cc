// Disks that are full, and folders that cannot be written to: what stood there stays, and nothing half-written is left.
#include <doctest/doctest.h>

#include <grp.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
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

constexpr const char* kOld = "the old file";

// No file may be larger: as on a disk that is full, but for this process alone.
void limit_files(rlim_t bytes) {
  const rlimit small{bytes, RLIM_INFINITY};
  ::setrlimit(RLIMIT_FSIZE, &small);
}

// A command, and the file that it cannot write.
struct Attempt {
  Arguments arguments;
  std::string file;
  rlim_t limit = 400;
};

Arguments render(const Arguments& more) {
  Arguments all = {"render", test::box(), "-r", "32", "24", "-q", "-s", "2"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

// In a folder with a.pfm, b.pfm, and the film files one.exr and two.exr.
std::vector<Attempt> attempts() {
  constexpr rlim_t kHoldsPicture = 32 * 24 * 12 + 100;
  return {{render({"-f", "out.png"}), "out.png"},
          {render({"-f", "out.exr"}), "out.exr"},
          {render({"-f", "out.pfm"}), "out.pfm"},
          {render({"-f", "out.hdr"}), "out.hdr"},
          {render({"-f", "small.png", "--rate", "rate.pfm"}), "rate.pfm", kHoldsPicture - 200},
          {render({"-f", "small.png", "--stats", "stats.json"}), "stats.json", 2000},
          {{"merge", "one.exr", "two.exr", "-q", "-f", "out.exr"}, "out.exr"},
          {{"merge", "one.exr", "two.exr", "-q", "-f", "out.png"}, "out.png"},
          {{"compare", "a.pfm", "b.pfm", "--metric", "flip", "--map", "map.png"}, "map.png"},
          {{"compare", "a.pfm", "b.pfm", "--metric", "flip", "--map", "map.exr"}, "map.exr"},
          {{"convert", test::box(), "-q", "-f", "box.xml"}, "box.xml", 1200},
          {{"convert", test::box(), "-q", "-f", "box.pbrt"}, "box.pbrt", 1200},
          {{"plan", test::box(), "-q", "--json", "plan.json"}, "plan.json"}};
}

void prepare_inputs(const TemporaryFolder& folder) {
  const auto run = [&](const Arguments& more) {
    REQUIRE(test::run_process(test::program(), render(more), folder.path()).exit_code == 0);
  };
  run({"-f", "a.pfm"});
  run({"-f", "b.pfm", "--seed", "1"});
  for (const auto& [name, samples] : {std::pair{"one.exr", "0:2"}, {"two.exr", "2:4"}}) {
    const Arguments part = {"render", test::box(), "-r", "32", "24", "-q", "--samples", samples, "-f", name};
    REQUIRE(test::run_process(test::program(), part, folder.path()).exit_code == 0);
  }
}

bool has_rubbish(const TemporaryFolder& folder) {
  for (const auto& entry : fs::recursive_directory_iterator(folder.path())) {
    const std::string name = entry.path().filename().string();
    if (name.find(".tmp") != std::string::npos || name.starts_with("lanewise-") || name.ends_with(".lock")) return true;
  }
  return false;
}

// To a user who may not write where root may. False: not possible here.
bool become_nobody() {
  constexpr unsigned kNobody = 65534;
  if (::geteuid() != 0) return true;  // chmod is enough
  return ::setgroups(0, nullptr) == 0 && ::setgid(kNobody) == 0 && ::setuid(kNobody) == 0;
}

void allow(const std::string& path, unsigned mode) { fs::permissions(path, static_cast<fs::perms>(mode)); }

// That the program and its scenes are there for others, too.
bool others_can_run() {
  const TemporaryFolder folder;
  allow(folder.path().string(), 0755);
  const bool can = test::run_process(test::program(), {"info", test::box()}, folder.path(), [] {
                     if (!become_nobody()) ::_exit(125);
                   }).exit_code == 0;
  if (!can) MESSAGE("skipped: no other user can run " << test::program() << " here");
  return can;
}

}  // namespace

TEST_CASE("unwritable: on a full disk the old file stays, one line says why, and no rubbish is left") {
  if (test::nothing_to_test()) return;
  const TemporaryFolder folder;
  prepare_inputs(folder);
  for (const Attempt& attempt : attempts()) {
    for (const bool old : {true, false}) {
      CAPTURE(attempt.arguments.front());
      CAPTURE(attempt.file);
      if (old) test::write_text(folder.file(attempt.file), kOld);
      const ProcessResult r = test::run_process(test::program(), attempt.arguments, folder.path(), [&] {
        ::setenv("TMPDIR", folder.path().c_str(), 1);
        limit_files(attempt.limit);
      });
      CHECK(r.exit_code == 1);
      CAPTURE(r.err);
      CHECK(std::count(r.err.begin(), r.err.end(), '\n') == 1);
      CHECK(r.err.find(": cannot write: File too large") != std::string::npos);
      CHECK(r.err.find(attempt.file.substr(0, attempt.file.find('.'))) != std::string::npos);
      CHECK(fs::exists(folder.file(attempt.file)) == old);
      if (old) CHECK(test::read_text(folder.file(attempt.file)) == kOld);
      CHECK_FALSE(has_rubbish(folder));
      CHECK_FALSE(fs::exists(folder.file("box_meshes")));
      fs::remove(folder.file(attempt.file));
    }
  }
}

TEST_CASE("unwritable: a folder that may not be written to is refused before the work, and left as it is") {
  if (test::nothing_to_test() || !others_can_run()) return;
  const TemporaryFolder folder;
  prepare_inputs(folder);
  allow(folder.path().string(), 0555);
  std::vector<Attempt> all = attempts();
  all.push_back({render({"-f", "/dev/shm/never.pfm", "--checkpoint", "c.exr"}), "c.exr"});
  for (Attempt& attempt : all) {
    CAPTURE(attempt.arguments.front());
    CAPTURE(attempt.file);
    const std::vector<std::string> before = folder.names();
    const auto start = std::chrono::steady_clock::now();
    for (size_t i = 0; i < attempt.arguments.size(); ++i) {
      if (attempt.arguments[i] == "-s") attempt.arguments[i + 1] = "1000000000";  // that would take hours
    }
    const ProcessResult r =
        test::run_process(test::program(), attempt.arguments, folder.path(), [] { become_nobody(); });
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    CAPTURE(r.err);
    CHECK(r.exit_code == 1);
    CHECK(std::count(r.err.begin(), r.err.end(), '\n') == 1);
    CHECK(r.err.find(": cannot write: Permission denied") != std::string::npos);
    CHECK(taken.count() < 30);
    CHECK(folder.names() == before);
  }
  allow(folder.path().string(), 0755);
}

TEST_CASE("unwritable: a folder that is made read-only while a render draws loses none of it") {
  if (test::nothing_to_test() || !others_can_run()) return;
  const TemporaryFolder folder;
  for (const char* name : {"out", "elsewhere"}) {
    fs::create_directory(folder.file(name));
    allow(folder.file(name), 0777);
  }
  allow(folder.path().string(), 0755);
  const std::string picture = (fs::path("out") / "box.pfm").string();
  Running running(folder,
                  {"render", test::box(), "-r", "32", "24", "-q", "-s", "1000000000", "-f", picture, "--checkpoint",
                   "out/c.exr", "--every", "10ms"},
                  [&] {
                    ::setenv("TMPDIR", folder.file("elsewhere").c_str(), 1);
                    become_nobody();
                  });
  running.wait_for("out/c.exr");
  allow(folder.file("out"), 0555);
  Running::sleep(std::chrono::milliseconds(200));
  CHECK(running.end(SIGTERM) == 1);
  const std::string err = test::read_text(folder.file("err"));
  CAPTURE(err);
  CHECK(err.find("out/box.pfm: cannot write: Permission denied: it is kept as ") != std::string::npos);
  CHECK(err.find("out/c.exr: cannot write: Permission denied: it is kept as ") != std::string::npos);
  size_t kept = 0;
  for (const auto& entry : fs::directory_iterator(folder.file("elsewhere"))) {
    kept += entry.path().filename().string().starts_with("lanewise-");
  }
  CHECK(kept == 2);
  CHECK(fs::exists(folder.file("out/c.exr")));  // the last that could be written
  allow(folder.file("out"), 0777);
}

}  // namespace lanewise
