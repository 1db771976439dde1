#include "tests/kernel_harness.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/render.h"
#include "core/verify/oracle.h"
#include "core/verify/test_scene.h"
#include "core/isa.h"

namespace lanewise::test {
namespace {

using verify::Expected;
using verify::KernelCase;
using verify::Oracle;
using verify::Tally;

// Paths in slots begin, begin + 1, ..., and what the twin makes of them.
struct Wave {
  uint32_t begin = 0;
  std::vector<Path<float>> before;
  std::vector<Expected> expected;
};

std::vector<Wave> make_waves(const Plan& plan, const KernelCase& kernel, const Oracle& oracle, const Step& step,
                             const std::function<void(std::mt19937&, Path<float>&)>& change) {
  std::vector<uint32_t> counts;
  for (uint32_t n = 0; n <= 2 * kLanes; ++n) counts.push_back(n);
  counts.push_back(1000);
  std::mt19937 rng(7);
  std::vector<Wave> waves;
  for (const uint32_t n : counts) {
    Wave wave;
    wave.begin = n % 2 == 1 && n < kLanes ? kLanes : 0;  // ranges need not begin at 0
    for (uint32_t i = 0; i < n; ++i) {
      Path<float> p;
      p.slot = wave.begin + i;
      p.step = step;
      if (plan.prim_shape.empty()) {  // bare materials: nothing to hit
        fill_random(plan, rng, p, p.slot);
      } else {
        kernel.fill(plan, rng, p);
      }
      if (change) change(rng, p);
      wave.before.push_back(p);
      wave.expected.push_back(oracle.expect(p));
    }
    waves.push_back(wave);
  }
  return waves;
}

}  // namespace

void for_each_target(const std::function<void(const char*)>& f) {
  const std::string before = chosen_isa();
  for (const std::string& isa : supported_isas()) {
    choose_isa(isa);
    f(isa.c_str());
  }
  choose_isa(before);
}

void check_kernel(const Plan& plan, const char* kernel, const Step& step,
                  const std::function<void(std::mt19937&, Path<float>&)>& change) {
  check_kernel(plan, verify::kernel_case(kernel), step, change);
}

void check_kernel(const Plan& plan, const KernelCase& kernel, const Step& step,
                  const std::function<void(std::mt19937&, Path<float>&)>& change) {
  const Oracle oracle(plan, kernel);
  const std::vector<Wave> waves = make_waves(plan, kernel, oracle, step, change);
  for_each_target([&](const char* target) {
    Tally tally = oracle.tally();
    for (const Wave& wave : waves) {
      const uint32_t n = static_cast<uint32_t>(wave.before.size());
      PathBuffer buffer(std::max(n, kLanes) + kLanes);
      PathState& s = buffer.state();
      s.step = step;
      for (uint32_t i = 0; i < n; ++i) store_path(s, wave.begin + i, wave.before[i]);
      kernel.kernel(plan, s, {wave.begin, wave.begin + n});
      for (uint32_t i = 0; i < n; ++i) {
        const Path<float> got = load_path<float>(s, wave.begin + i);
        oracle.compare(wave.before[i], wave.expected[i], got, tally);
      }
    }
    CAPTURE(kernel.name);
    CAPTURE(target);
    CAPTURE(tally.first_failure);
    CHECK(tally.failed == 0);
    CHECK(tally.choices_within_bound());
  });
}

Plan test_plan(const Settings& settings) { return make_plan(test_scene(), settings); }

}  // namespace lanewise::test
