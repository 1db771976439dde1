// tools/slurm, on a farm that is a shell script.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "tests/program.h"
#include "tests/scene_paths.h"
#include "tests/subprocess.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

// Runs an array's tasks from the last to the first, then says a job's number.
constexpr const char* kSbatch = R"(#!/usr/bin/env bash
set -e
for job; do :; done
last=$(sed -n 's/^#SBATCH --array=0-//p' "$job")
for task in $(seq "${last:-0}" -1 0); do SLURM_ARRAY_TASK_ID=$task bash "$job" >&2; done
echo "$@" >>calls
echo 7
)";

}  // namespace

TEST_CASE("slurm: parts of a job array, merged, are the bits of one render; only missing ones are drawn again") {
  if (test::nothing_to_test()) return;
  const test::TemporaryFolder folder;
  const auto shell = [&](const std::string& command) { return test::run_shell(folder.path(), command); };
  std::ofstream(folder.file("sbatch")) << kSbatch;
  std::filesystem::permissions(folder.file("sbatch"), std::filesystem::perms::owner_all);
  const std::string flags = "'" + test::box() + "' -r 32 24 -q -f ";
  const std::string farm = "PATH=$PWD:$PATH LANEWISE=" + test::program() + " " +
                           (test::source_dir() / "tools/slurm").string() + " --parts 5 --samples 33 " + flags;
  REQUIRE(shell(test::program() + " render -s 33 " + flags + "one.pfm").exit_code == 0);
  const test::ProcessResult ran = shell(farm + "'a b.pfm' --sbatch '--partition=night --time=1:00'");
  CAPTURE(ran.err);
  CHECK(ran.exit_code == 0);
  CHECK(test::read_text(folder.file("a b.pfm")) == test::read_text(folder.file("one.pfm")));
  CHECK(test::read_text(folder.file("calls")) ==
        "--parsable --partition=night --time=1:00 a b.pfm.parts/part.sh\n"
        "--parsable --partition=night --time=1:00 --dependency=afterok:7 --kill-on-invalid-dep=yes a "
        "b.pfm.parts/merge.sh\n");

  const auto part = [&](const char* range) { return folder.file(std::string("a b.pfm.parts/") + range + ".exr"); };
  const auto before = std::filesystem::last_write_time(part("6-13"));
  std::filesystem::remove(part("19-26"));
  CHECK(shell(farm + "'a b.pfm'").exit_code == 0);
  CHECK(std::filesystem::exists(part("19-26")));
  CHECK(std::filesystem::last_write_time(part("6-13")) == before);

  CHECK(shell(farm + "'a b.pfm' -m 3").err.find("parts of another render") != std::string::npos);
  CHECK(shell(farm + "'a b.pfm' --parts 3 --samples 40").exit_code == 0);  // of the same, and other samples
  REQUIRE(shell(test::program() + " render -s 40 " + flags + "forty.pfm").exit_code == 0);
  CHECK(test::read_text(folder.file("a b.pfm")) == test::read_text(folder.file("forty.pfm")));

  CHECK(shell(farm + "x.png -s 5").exit_code == 2);
  CHECK(shell(farm + "x.png --stats=s.json").exit_code == 2);
  CHECK(shell(farm + "x.png --parts 34").exit_code == 2);
}

}  // namespace lanewise
