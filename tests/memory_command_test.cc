// Little memory: --max-memory, and limits that the system keeps from outside.
#include <doctest/doctest.h>

#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/program.h"
#include "tests/subprocess.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

using Arguments = std::vector<std::string>;
using test::ProcessResult;
using test::TemporaryFolder;

// Sanitizers take terabytes of addresses, and more memory than they check.
bool is_sanitized() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  MESSAGE("skipped: built with sanitizers");
  return true;
#else
  return false;
#endif
}

Arguments render(const Arguments& more) {
  Arguments all = {"render", test::box(), "-r", "64", "48", "-q", "-s", "4", "-t", "4"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

void hold(decltype(RLIMIT_AS) resource, rlim_t bytes) {
  const rlimit limit{bytes, bytes};
  ::setrlimit(resource, &limit);
}

long lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

constexpr rlim_t kMegabyte = 1 << 20;

}  // namespace

TEST_CASE("memory: --max-memory refuses what needs more before the work, and says what needs how much") {
  if (test::nothing_to_test()) return;
  const TemporaryFolder folder;
  const auto run = [&](const Arguments& arguments) {
    return test::run_process(test::program(), arguments, folder.path());
  };
  const std::string long_time = "1000000000";  // samples
  const ProcessResult film = run(render({"-r", "8000", "6000", "-s", long_time, "--max-memory", "2G", "-f", "a.png"}));
  CHECK(film.exit_code == 1);
  CHECK(film.err.starts_with("lanewise: --max-memory: the render needs "));
  CHECK(film.err.find("M, more than 2048M: ") != std::string::npos);
  CHECK(film.err.find("M for the film, ") != std::string::npos);
  CHECK(film.err.find("; a smaller --resolution (-r) needs less\n") != std::string::npos);
  const ProcessResult paths =
      run(render({"-t", "64", "--wave", "1048576", "-s", long_time, "--max-memory", "2G", "-f", "a.png"}));
  CHECK(paths.exit_code == 1);
  CHECK(paths.err.find("; fewer --threads (-t) needs less\n") != std::string::npos);
  CHECK(run({"plan", test::box(), "-r", "8000", "6000", "-q", "-t", "4", "--max-memory", "2G"})
            .err.starts_with("lanewise: --max-memory: the render needs "));
  for (const char* wrong : {"0", "2X", "G", "-1G", "1e99", ""}) {
    CHECK(run(render({"--max-memory", wrong, "-f", "a.png"})).exit_code == 2);
  }
  CHECK_FALSE(std::filesystem::exists(folder.file("a.png")));
}

TEST_CASE("memory: what --max-memory says is enough is enough, and less is held to") {
  if (test::nothing_to_test() || is_sanitized()) return;
  const TemporaryFolder folder;
  const std::vector<Arguments> modes = {{"-f", "a.png"},
                                        {"-f", "a.exr"},
                                        {"-f", "a.pfm", "--noise", "0.5", "-s", "32"},
                                        {"-f", "a.exr", "--checkpoint", "c.exr"}};
  for (const Arguments& mode : modes) {
    CAPTURE(mode[1]);
    const auto with = [&](const std::string& limit) {
      Arguments all = render({"-r", "500", "400", "-s", "1", "-t", "2", "--max-memory", limit});
      all.insert(all.end(), mode.begin(), mode.end());
      return test::run_process(test::program(), all, folder.path());
    };
    const std::string said = with("35M").err, words = "needs ";
    CAPTURE(said);
    REQUIRE(said.find(words) != std::string::npos);
    const std::string need = said.substr(said.find(words) + words.size());
    const ProcessResult enough = with(need.substr(0, need.find('M')) + "M");
    CHECK(enough.exit_code == 0);
    CHECK(enough.err == "");
  }
  // The loader's peak is not foreseen: the limit itself ends it.
  const ProcessResult held = test::run_process(test::program(), {"info", "builtin:dense"}, folder.path(),
                                               [] { hold(RLIMIT_DATA, 20 * kMegabyte); });
  CHECK(held.err == "lanewise: not enough memory\n");
  const ProcessResult loading = test::run_process(
      test::program(), {"render", "builtin:dense", "-q", "-f", "dense.png", "--max-memory", "30M"}, folder.path());
  CHECK(loading.exit_code == 1);
  CHECK(loading.err == "lanewise: not enough memory within --max-memory, 30M\n");
  CHECK_FALSE(std::filesystem::exists(folder.file("dense.png")));
  // Nor is a scene without room to be read taken for a broken one.
  const ProcessResult none =
      test::run_process(test::program(), render({"-f", "a.png", "--max-memory", "1K"}), folder.path());
  CHECK(none.err == "lanewise: not enough memory within --max-memory, 1M\n");
}

TEST_CASE("memory: however little there is, a command comes to its right end, or says in one line that it cannot") {
  if (test::nothing_to_test() || is_sanitized()) return;
  const TemporaryFolder folder;
  REQUIRE(test::run_process(test::program(), render({"-f", "want.pfm"}), folder.path()).exit_code == 0);
  const std::string want = test::read_text(folder.file("want.pfm"));
  int good = 0, refused = 0;
  for (const auto resource : {RLIMIT_AS, RLIMIT_DATA}) {
    for (int i = 0; i < 40; ++i) {
      // Of addresses from what the program's libraries take; of data from nearly nothing.
      const rlim_t bytes = (resource == RLIMIT_AS ? 30 + 5 * i : 2 + i) * kMegabyte;
      CAPTURE(bytes);
      std::filesystem::remove(folder.file("got.pfm"));
      const ProcessResult r =
          test::run_process(test::program(), render({"-f", "got.pfm"}), folder.path(), [&] { hold(resource, bytes); });
      CAPTURE(r.err);
      if (r.exit_code == 0) {
        ++good;
        CHECK(test::read_text(folder.file("got.pfm")) == want);
      } else {
        // 127: there is not even room for the libraries.
        CHECK((r.exit_code == 1 || r.exit_code == 127));
        refused += r.exit_code == 1;
        CHECK(lines(r.err) == 1);
        CHECK_FALSE(std::filesystem::exists(folder.file("got.pfm")));
      }
    }
  }
  CHECK(good > 10);
  CHECK(refused > 2);

  // OpenEXR makes exceptions of its own of it, which name no file.
  for (rlim_t megabytes = 24; megabytes < 120; megabytes += 3) {
    const Arguments arguments = render({"-r", "500", "400", "-s", "1", "-f", "got.exr", "--checkpoint", "c.exr"});
    std::filesystem::remove(folder.file("c.exr"));
    const ProcessResult r = test::run_process(test::program(), arguments, folder.path(), [&] {
      ::setenv("TMPDIR", folder.path().c_str(), 1);
      hold(RLIMIT_DATA, megabytes * kMegabyte);
    });
    CAPTURE(megabytes);
    CAPTURE(r.err);
    CHECK(r.exit_code <= 1);
    CHECK(lines(r.err) <= 2);  // a warning of the checkpoint before
    CHECK(r.err.find("(string)") == std::string::npos);
  }
}

TEST_CASE("memory: threads that the machine does not give leave the others, or this one, to work") {
  if (test::nothing_to_test() || is_sanitized()) return;
  const TemporaryFolder folder;
  REQUIRE(test::run_process(test::program(), render({"-f", "want.pfm"}), folder.path()).exit_code == 0);
  // A thread's stack takes as many addresses as this: of three threads, or of none.
  for (const auto& [stack, addresses] : {std::pair{512, 2000}, {4000, 2000}}) {
    CAPTURE(stack);
    const ProcessResult r = test::run_process(test::program(), render({"-t", "16", "-f", "got.pfm"}), folder.path(),
                                              [stack = stack, addresses = addresses] {
                                                const rlimit limit{stack * kMegabyte, RLIM_INFINITY};
                                                ::setrlimit(RLIMIT_STACK, &limit);
                                                hold(RLIMIT_AS, addresses * kMegabyte);
                                              });
    CAPTURE(r.err);
    CHECK(r.exit_code == 0);
    CHECK(test::read_text(folder.file("got.pfm")) == test::read_text(folder.file("want.pfm")));
  }
}

TEST_CASE("memory: a thread that gets none ends the render, and leaves its checkpoint as it was") {
  if (test::nothing_to_test() || is_sanitized()) return;
  const TemporaryFolder folder;
  const Arguments begin = render({"-s", "20", "-f", "a.pfm", "--checkpoint", "c.exr"});
  REQUIRE(test::run_process(test::program(), begin, folder.path()).exit_code == 0);
  const std::string before = test::read_text(folder.file("c.exr"));
  const auto go_on = [&](const Arguments& more) {
    Arguments all = render({"-s", "100", "-f", "b.pfm", "--checkpoint", "c.exr", "--resume"});
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  // Each thread's paths take hundreds of megabytes, which it asks for itself.
  const ProcessResult r = test::run_process(test::program(), go_on({"--wave", "1048576", "-t", "8"}), folder.path(),
                                            [] { hold(RLIMIT_DATA, 200 * kMegabyte); });
  CHECK(r.exit_code == 1);
  CHECK(r.err == "lanewise: not enough memory\n");
  CHECK(test::read_text(folder.file("c.exr")) == before);
  CHECK_FALSE(std::filesystem::exists(folder.file("b.pfm")));
  CHECK_FALSE(std::filesystem::exists(folder.file("c.exr.lock")));

  CHECK(test::run_process(test::program(), go_on({}), folder.path()).exit_code == 0);
  CHECK(test::run_process(test::program(), render({"-s", "100", "-f", "want.pfm"}), folder.path()).exit_code == 0);
  CHECK(test::read_text(folder.file("b.pfm")) == test::read_text(folder.file("want.pfm")));
}

}  // namespace lanewise
