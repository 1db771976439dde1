// --checkpoint, --resume, --samples and merge, as a user meets them: processes that are killed, stopped, or in each other's way.
#include <doctest/doctest.h>

#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <random>

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

ProcessResult lanewise(const TemporaryFolder& folder, const Arguments& arguments) {
  return test::run_process(test::program(), arguments, folder.path());
}

Arguments render(const Arguments& more, const std::string& output = "box.pfm") {
  Arguments all = {"render", test::box(), "-r", "64", "48", "-q", "-f", output};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

const Arguments kLong = {"-s", "1000000000", "--checkpoint", "c.exr", "--every", "100ms"};

}  // namespace

TEST_CASE("checkpoint command: killed at any moment, the render goes on and ends with the same bits") {
  if (test::nothing_to_test()) return;
  std::mt19937 rng(std::random_device{}());
  const std::vector<Arguments> modes = {
      {"-s", "1200"}, {"-s", "2000", "-a", "64", "0.02"}, {"-s", "1024", "--noise", "0.02"}};
  for (const Arguments& mode : modes) {
    CAPTURE(mode.back());
    const TemporaryFolder folder;
    REQUIRE(lanewise(folder, render(mode, "want.pfm")).exit_code == 0);
    const std::string want = test::read_text(folder.file("want.pfm"));
    Arguments arguments = render(mode);
    arguments.insert(arguments.end(), {"--checkpoint", "c.exr", "--every", "20ms", "--resume"});
    for (int kills = 0; kills < 4; ++kills) {
      Running running(folder, arguments);
      Running::sleep(std::chrono::milliseconds(rng() % 300));
      const int ended = running.end(SIGKILL);
      CHECK((ended == 128 + SIGKILL || ended == 0));
    }
    const ProcessResult last = lanewise(folder, arguments);
    CHECK(last.exit_code == 0);
    const bool same = test::read_text(folder.file("box.pfm")) == want;
    CHECK(same);
  }
}

TEST_CASE("checkpoint command: SIGINT and SIGTERM leave picture and checkpoint, and say how to go on") {
  if (test::nothing_to_test()) return;
  for (const int signal : {SIGINT, SIGTERM}) {
    const TemporaryFolder folder;
    Running running(folder, render(kLong));
    running.wait_for("c.exr");
    CHECK(running.end(signal) == 128 + signal);
    CHECK(std::filesystem::exists(folder.file("box.pfm")));
    CHECK(std::filesystem::exists(folder.file("c.exr")));
    CHECK_FALSE(std::filesystem::exists(folder.file("c.exr.lock")));
    const std::string err = test::read_text(folder.file("err"));
    CHECK(err.starts_with("lanewise: stopped by SIG"));
    CHECK(err.find("--resume goes on") != std::string::npos);
    // No file is left half written.
    for (const std::string& name : folder.names()) CHECK(name.find(".tmp") == std::string::npos);
  }
}

TEST_CASE("checkpoint command: what would lose or mix up renders is refused") {
  if (test::nothing_to_test()) return;
  const TemporaryFolder folder;
  const Arguments checkpoint = {"-s", "8", "--checkpoint", "c.exr"};
  const auto with = [&](Arguments more) {
    Arguments all = checkpoint;
    all.insert(all.end(), more.begin(), more.end());
    return render(all);
  };
  REQUIRE(lanewise(folder, with({})).exit_code == 0);
  const auto refuses = [&](const Arguments& arguments, const std::string& why) {
    const ProcessResult result = lanewise(folder, arguments);
    CAPTURE(result.err);
    CHECK(result.exit_code != 0);
    CHECK(result.err.find("c.exr: ") != std::string::npos);
    CHECK(result.err.find(why) != std::string::npos);
  };
  refuses(with({}), "is there already");
  refuses(with({"--resume", "-m", "3"}), "cannot resume: max-depth is 5, not 3");
  refuses(with({"--resume", "-s", "4"}), "more samples than are asked for");
  refuses(with({"--resume", "--noise", "0.1", "-s", "64"}), "cannot resume: noise");
  test::write_text(folder.file("c.exr"), test::read_text(folder.file("c.exr")).substr(0, 10000));
  refuses(with({"--resume"}), "cannot read the film");

  // Another process that has it.
  std::filesystem::remove(folder.file("c.exr"));
  Running first(folder, render(kLong));
  first.wait_for("c.exr");
  refuses(render({"-s", "8", "--checkpoint", "c.exr", "--resume"}), "another render is writing it");
  CHECK(first.end(SIGTERM) == 128 + SIGTERM);
}

TEST_CASE(
    "checkpoint command: a checkpoint that cannot be written is warned of, and the render goes on to its picture") {
  if (test::nothing_to_test()) return;
  const TemporaryFolder folder;
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{100'000, before.rlim_max};  // holds the picture
  ::setrlimit(RLIMIT_FSIZE, &small);
  const ProcessResult result = lanewise(folder, render({"-s", "300", "--checkpoint", "c.exr", "--every", "1ms"}));
  ::setrlimit(RLIMIT_FSIZE, &before);
  CAPTURE(result.err);
  CHECK(result.exit_code == 1);
  CHECK(result.err.find("warning: c.exr: cannot write: File too large; rendering goes on") != std::string::npos);
  CHECK(std::filesystem::file_size(folder.file("box.pfm")) > 64 * 48 * 12);
  // One that was small enough, of the first samples, is still whole.
  CHECK(lanewise(folder, render({"-s", "300", "--checkpoint", "c.exr", "--resume"})).exit_code == 0);
  for (const std::string& name : folder.names()) CHECK(name.find(".tmp") == std::string::npos);
}

TEST_CASE("merge command: parts, in any order, are the picture of all samples") {
  if (test::nothing_to_test()) return;
  const TemporaryFolder folder;
  const std::pair<const char*, const char*> parts[] = {{"a.exr", "0:7"}, {"b.exr", "7:24"}, {"c.exr", "24:40"}};
  REQUIRE(lanewise(folder, render({"-s", "40", "--allocation", "noise"}, "want.pfm")).exit_code == 0);
  for (const auto& [name, samples] : parts) {
    REQUIRE(lanewise(folder, render({"--samples", samples, "--allocation", "noise"}, name)).exit_code == 0);
  }
  CHECK(lanewise(folder, {"merge", "c.exr", "a.exr", "b.exr", "-q", "-f", "got.pfm"}).exit_code == 0);
  const bool same_by_noise = test::read_text(folder.file("got.pfm")) == test::read_text(folder.file("want.pfm"));
  CHECK(same_by_noise);
  REQUIRE(lanewise(folder, render({"--samples", "0:7"}, "even.exr")).exit_code == 0);
  CHECK(lanewise(folder, {"merge", "even.exr", "b.exr", "-f", "no.exr"}).err ==
        "lanewise: b.exr: cannot merge: allocation is noise, not even\n");
  // What is merged has its shares still, and goes on.
  REQUIRE(lanewise(folder, {"merge", "c.exr", "a.exr", "b.exr", "-q", "-f", "all.exr"}).exit_code == 0);
  const std::vector<std::string> more = {"-s", "64", "--allocation", "noise", "--checkpoint", "all.exr", "--resume"};
  REQUIRE(lanewise(folder, render(more, "got.pfm")).exit_code == 0);
  REQUIRE(lanewise(folder, render({"-s", "64", "--allocation", "noise"}, "want.pfm")).exit_code == 0);
  const bool same_when_resumed = test::read_text(folder.file("got.pfm")) == test::read_text(folder.file("want.pfm"));
  CHECK(same_when_resumed);

  REQUIRE(lanewise(folder, render({"-s", "40"}, "want.pfm")).exit_code == 0);
  for (const auto& [name, samples] : parts) {
    REQUIRE(lanewise(folder, render({"--samples", samples}, name)).exit_code == 0);
  }
  const ProcessResult two = lanewise(folder, {"merge", "c.exr", "a.exr", "-f", "ac.exr"});
  CHECK(two.out.find("0:7, 24:40") != std::string::npos);
  CHECK(two.out.find("note: samples between these are missing") != std::string::npos);
  CHECK(lanewise(folder, {"merge", "ac.exr", "b.exr", "-q", "-f", "got.pfm"}).exit_code == 0);
  const bool same = test::read_text(folder.file("got.pfm")) == test::read_text(folder.file("want.pfm"));
  CHECK(same);

  const ProcessResult twice = lanewise(folder, {"merge", "a.exr", "ac.exr", "-f", "no.exr"});
  CHECK(twice.exit_code == 1);
  CHECK(twice.err == "lanewise: ac.exr: cannot merge: samples 0:7 are there already\n");
  CHECK(lanewise(folder, {"merge", "a.exr", "b.exr", "-f", "a.exr"}).exit_code == 2);
  CHECK(lanewise(folder, {"merge", "a.exr", "nowhere.exr", "-f", "no.exr"}).err.starts_with("lanewise: nowhere.exr: "));
  CHECK_FALSE(std::filesystem::exists(folder.file("no.exr")));
}

}  // namespace lanewise
