#include "tests/kernel_harness.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>

#include "core/render.h"
#include "tests/random_path.h"
#include "tests/test_scene.h"

namespace lanewise::test {
namespace {

// The fields of a path by name and 4-byte word, for comparison.
struct Field {
  const char* name;
  bool is_float;
  uint32_t word;
  double value;
};

std::vector<Field> fields(const Path<float>& p) {
  std::vector<Field> result;
#define LANEWISE_FIELD(type, name, meaning)                                       \
  {                                                                               \
    uint32_t word;                                                                \
    std::memcpy(&word, &p.name, sizeof word);                                     \
    result.push_back({#name, std::is_same_v<type, float>, word, double(p.name)}); \
  }
  LANEWISE_PATH_FIELDS(LANEWISE_FIELD, LANEWISE_FIELD)
#undef LANEWISE_FIELD
  return result;
}

// What is wrong with the lane, or "".
std::string compare(const KernelCase& test, const Path<float>& before, const Path<float>& got,
                    const Path<float>& want) {
  const std::vector<Field> b = fields(before), g = fields(got), w = fields(want);
  for (size_t f = 0; f < g.size(); ++f) {
    const Write* write = nullptr;
    for (const Write& candidate : test.writes) {
      if (candidate.field == g[f].name) write = &candidate;
    }
    if (!write) {
      if (g[f].word != b[f].word) return std::string(g[f].name) + " changed but is not on the kernel's list";
      continue;
    }
    if (g[f].word == w[f].word || g[f].value == w[f].value) continue;
    const double error = std::abs(g[f].value - w[f].value);
    if (g[f].is_float && error <= write->abs + write->rel * std::abs(w[f].value)) continue;
    return std::string(g[f].name) + " is " + std::to_string(g[f].value) + ", the twin's " + std::to_string(w[f].value) +
           ", error " + std::to_string(error);
  }
  return "";
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

void check_kernel(const Plan& plan, const KernelCase& test,
                  const std::function<void(std::mt19937&, Path<float>&)>& fill) {
  std::vector<uint32_t> counts;
  for (uint32_t n = 0; n <= 2 * kLanes; ++n) counts.push_back(n);
  counts.push_back(1000);
  for_each_target([&](const char* target) {
    std::mt19937 rng(7);
    uint32_t compared = 0, borderline = 0, wrong = 0;
    std::string first_wrong;
    for (const uint32_t n : counts) {
      PathBuffer buffer(std::max(n, kLanes) + kLanes);
      PathState& s = buffer.state();
      s.step = test.step;
      const uint32_t begin = n % 2 == 1 && n < kLanes ? kLanes : 0;  // ranges need not begin at 0
      std::vector<Path<float>> before(n);
      for (uint32_t i = 0; i < n; ++i) {
        fill_random(plan, rng, before[i], i);
        before[i].step = test.step;
        if (fill) fill(rng, before[i]);
        store_path(s, begin + i, before[i]);
      }
      test.kernel(plan, s, {begin, begin + n});
      for (uint32_t i = 0; i < n; ++i) {
        Path<float> want = before[i];
        test.twin(plan, want);
        if (test.borderline && test.borderline(before[i], want)) {
          ++borderline;
          continue;
        }
        ++compared;
        const std::string error = compare(test, before[i], load_path<float>(s, begin + i), want);
        if (error.empty()) continue;
        if (wrong++ == 0) first_wrong = "lane " + std::to_string(i) + " of " + std::to_string(n) + ": " + error;
      }
    }
    CAPTURE(target);
    CAPTURE(first_wrong);
    CHECK(wrong == 0);
    CHECK(compared > 0);
    CHECK(borderline <= test.max_borderline * (compared + borderline));
  });
}

Plan test_plan(const Settings& settings) { return make_plan(test_scene(), settings); }

}  // namespace lanewise::test
