// Standard input, output and error that are closed, full, or read by nobody.
#include <doctest/doctest.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/program.h"
#include "tests/running.h"
#include "tests/subprocess.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

using Arguments = std::vector<std::string>;
using test::ProcessResult;
using test::Running;
using test::TemporaryFolder;

// The descriptor leads to a pipe that nobody reads.
void break_pipe(int fd) {
  int ends[2];
  if (::pipe(ends) != 0) ::_exit(126);
  ::close(ends[0]);
  ::dup2(ends[1], fd);
  ::close(ends[1]);
}

void fill(int fd) { ::dup2(::open("/dev/full", O_WRONLY), fd); }

const Arguments kSmall = {"render", test::box(), "-r", "32", "24", "-s", "2"};

Arguments with(Arguments all, const Arguments& more) {
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

// Commands that write to standard output, in a folder with two.pfm.
std::vector<Arguments> talkative() {
  return {{"info", test::box()},
          {"info", test::box(), "--json"},
          {"plan", test::box()},
          {"plan", test::box(), "-q", "--json", "/dev/stdout"},
          {"compare", "two.pfm", "two.pfm"},
          {"compare", "two.pfm", "two.pfm", "--json"},
          {"render", "--help"},
          {"--version"},
          {"generate", "man"},
          with(kSmall, {"-f", "one.pfm"})};
}

}  // namespace

TEST_CASE("streams: where nobody reads standard output, a command ends by SIGPIPE, in silence, when all is written") {
  if (test::nothing_to_test()) return;
  const TemporaryFolder folder;
  REQUIRE(test::run_process(test::program(), with(kSmall, {"-f", "two.pfm"}), folder.path()).exit_code == 0);
  for (const Arguments& arguments : talkative()) {
    CAPTURE(arguments.front());
    CAPTURE(arguments.back());
    const ProcessResult r =
        test::run_process(test::program(), arguments, folder.path(), [] { break_pipe(STDOUT_FILENO); });
    CHECK(r.exit_code == 128 + SIGPIPE);
    CHECK(r.err == "");
  }
  CHECK(test::read_text(folder.file("one.pfm")) == test::read_text(folder.file("two.pfm")));

  // Nothing is said, so nothing is lost.
  const ProcessResult quiet = test::run_process(test::program(), with(kSmall, {"-q", "-f", "three.pfm"}), folder.path(),
                                                [] { break_pipe(STDOUT_FILENO); });
  CHECK(quiet.exit_code == 0);
}

TEST_CASE("streams: standard output that cannot be written is an error of one line, whatever fits into a buffer") {
  if (test::nothing_to_test()) return;
  const TemporaryFolder folder;
  REQUIRE(test::run_process(test::program(), with(kSmall, {"-f", "two.pfm"}), folder.path()).exit_code == 0);
  for (const Arguments& arguments : talkative()) {
    CAPTURE(arguments.front());
    CAPTURE(arguments.back());
    const ProcessResult r = test::run_process(test::program(), arguments, folder.path(), [] { fill(STDOUT_FILENO); });
    CHECK(r.exit_code == 1);
    const bool direct = arguments.back() == "/dev/stdout";
    CHECK(r.err == std::string("lanewise: ") + (direct ? "/dev/stdout" : "standard output") +
                       ": cannot write: No space left on device\n");
  }
  CHECK(test::read_text(folder.file("one.pfm")) == test::read_text(folder.file("two.pfm")));
}

TEST_CASE("streams: warnings that nobody reads do not end a render") {
  if (test::nothing_to_test()) return;
  const TemporaryFolder folder;
  REQUIRE(test::run_process(test::program(), with(kSmall, {"-q", "-f", "want.pfm"}), folder.path()).exit_code == 0);
  for (const auto& spoil : {break_pipe, fill}) {
    const Arguments arguments = with(kSmall, {"-f", "got.pfm", "--checkpoint", "c.exr", "--every", "1ms", "-q"});
    std::filesystem::remove(folder.file("got.pfm"));
    const ProcessResult r = test::run_process(test::program(), arguments, folder.path(), [&] {
      spoil(STDERR_FILENO);
      const rlimit small{15'000, RLIM_INFINITY};  // holds the picture, not the checkpoint
      ::setrlimit(RLIMIT_FSIZE, &small);
    });
    CHECK(r.exit_code == 1);
    CHECK(test::read_text(folder.file("got.pfm")) == test::read_text(folder.file("want.pfm")));
  }
}

TEST_CASE("streams: those that are closed lead nowhere, and not to files that are opened later") {
  if (test::nothing_to_test()) return;
  const TemporaryFolder folder;
  REQUIRE(test::run_process(test::program(), with(kSmall, {"-q", "-f", "want.pfm"}), folder.path()).exit_code == 0);
  for (int closed = 1; closed < 8; ++closed) {
    CAPTURE(closed);
    const auto close_them = [&] {
      for (int fd = 0; fd < 3; ++fd) {
        if (closed >> fd & 1) ::close(fd);
      }
    };
    const ProcessResult r =
        test::run_process(test::program(), with(kSmall, {"-f", "got.pfm"}), folder.path(), close_them);
    CHECK(r.exit_code == 0);
    CHECK(test::read_text(folder.file("got.pfm")) == test::read_text(folder.file("want.pfm")));

    // What stands in their places while a render has files open.
    Running running(
        folder,
        {"render", test::box(), "-s", "1000000000", "-f", "long.pfm", "--checkpoint", "c.exr", "--every", "10ms"}, [&] {
          const int null = ::open("/dev/null", O_RDWR);
          for (int fd = 0; fd < 3; ++fd) ::dup2(null, fd);
          ::close(null);
          close_them();
        });
    running.wait_for("c.exr");
    std::error_code error;
    for (int fd = 0; fd < 3; ++fd) {
      const std::string link = "/proc/" + std::to_string(running.process()) + "/fd/" + std::to_string(fd);
      CHECK(std::filesystem::read_symlink(link, error) == "/dev/null");
    }
    CHECK(running.end(SIGTERM) == 128 + SIGTERM);
    std::filesystem::remove(folder.file("c.exr"));
  }
}

}  // namespace lanewise
