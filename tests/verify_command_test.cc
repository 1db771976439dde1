// `lanewise verify` from outside. LANEWISE_BINARY names the program.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "core/verify/oracle.h"
#include "tests/kernel_harness.h"
#include "tests/subprocess.h"

namespace lanewise {
namespace {

test::ProcessResult verify_with(std::vector<std::string> arguments) {
  const char* program = std::getenv("LANEWISE_BINARY");
  const std::string path = std::filesystem::absolute(program ? program : "./lanewise").string();
  arguments.insert(arguments.begin(), "verify");
  return test::run_process(path, arguments, std::filesystem::temp_directory_path());
}

bool nothing_to_test() {
  const char* program = std::getenv("LANEWISE_BINARY");
  return !std::filesystem::exists(program ? program : "./lanewise");
}

}  // namespace

TEST_CASE("verify command: every kernel within its bounds, as a table and as JSON") {
  if (nothing_to_test()) return;
  const test::ProcessResult table = verify_with({"--paths", "512", "--isa", "scalar"});
  CAPTURE(table.out);
  CHECK(table.exit_code == 0);
  CHECK(table.out.ends_with("all within bounds\n"));
  const test::ProcessResult result = verify_with({"--paths", "512", "--json"});
  REQUIRE(result.exit_code == 0);
  std::set<std::string> kernels;
  for (const auto& row : nlohmann::json::parse(result.out)) {
    kernels.insert(row["kernel"]);
    CHECK(row["max_error"].get<double>() <= row["bound"].get<double>() + (row["unit"] == "share" ? 0.01 : 0));
    CHECK(row.contains("mean_error"));
  }
  for (const verify::KernelCase& c : verify::kernel_cases()) CHECK(kernels.count(c.name) == 1);
  CHECK(verify_with({"--paths", "0"}).exit_code == 2);
}

TEST_CASE("verify: a kernel that is wrong by a little is found") {
  static constexpr KernelBounds kBounds = kShadeMirrorBounds;
  verify::KernelCase wrong = {"shade_mirror",
                              [](const Plan& plan, const PathState& s, Range range) {
                                shade_mirror(plan, s, range);
                                for (uint32_t i = range.begin; i < range.end; ++i) s.d_x[i] += 1e-6f;
                              },
                              verify::kernel_case("shade_mirror").twin,
                              kBounds,
                              "o d n s",
                              verify::kernel_case("shade_mirror").fill};
  const Plan plan = test::test_plan();
  const verify::Oracle oracle(plan, wrong);
  verify::Tally tally = oracle.tally();
  std::mt19937 rng(1);
  PathBuffer buffer(64);
  std::vector<Path<float>> before(64);
  for (uint32_t i = 0; i < 64; ++i) {
    before[i].slot = i;
    wrong.fill(plan, rng, before[i]);
    store_path(buffer.state(), i, before[i]);
  }
  wrong.kernel(plan, buffer.state(), {0, 64});
  for (uint32_t i = 0; i < 64; ++i) {
    oracle.compare(before[i], oracle.expect(before[i]), load_path<float>(buffer.state(), i), tally);
  }
  CHECK(tally.failed == 64);
}

}  // namespace lanewise
