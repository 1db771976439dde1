#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <iterator>

#include "tests/kernel_harness.h"

namespace lanewise {
namespace {

// The KEPT words of a slot, which is all that the sort moves.
std::vector<uint32_t> kept_words(const PathState& s, uint32_t i, bool without_t) {
  std::vector<uint32_t> words;
#define LANEWISE_WORD(type, name, meaning)                                \
  if (!without_t || &s.name[i] != reinterpret_cast<const void*>(&s.t[i])) \
    words.push_back(std::bit_cast<uint32_t>(s.name[i]));
#define LANEWISE_IGNORE(type, name, meaning)
  LANEWISE_PATH_FIELDS(LANEWISE_WORD, LANEWISE_IGNORE)
#undef LANEWISE_WORD
#undef LANEWISE_IGNORE
  return words;
}

// Sorts n random paths whose bins come from next_bin, and checks everything that the sort promises. share_t: the states have
// one array for t.
void check_sort(uint32_t n, const std::function<uint32_t(uint32_t)>& next_bin, bool share_t = false) {
  const Plan plan = test::test_plan();
  const uint32_t capacity = round_up_to_lanes(std::max(n, 1u));
  PathBuffer from(capacity), to(capacity);
  if (share_t) to.state().t = from.state().t;
  std::mt19937 rng(n);
  uint32_t real = 0, dead = 0;
  for (uint32_t i = 0; i < n; ++i) {
    Path<float> p;
    test::fill_random(plan, rng, p, i);
    p.bin = next_bin(i);
    if (p.bin == kBinCount) {  // stands for padding between the bins of the sort before
      p = dummy_path(capacity);
    } else {
      ++real;
      if (p.bin == kFinished && i % 2) p.beta_r = p.beta_g = p.beta_b = 0, ++dead;
    }
    store_path(from.state(), i, p);
  }
  const std::vector<float> t(from.state().t, from.state().t + n);
  const Bins bins = sort_by_bin(from.state(), to.state(), {0, n});
  if (share_t) {  // of what is shared only padding is written
    uint32_t changed = 0;
    for (uint32_t i = 0; i < n; ++i) changed += from.state().t[i] != t[i] && from.state().t[i] != dummy_path(0).t;
    CHECK(changed == 0);
  }

  uint32_t sorted = 0, previous_end = 0;
  bool right = true;
  for (uint32_t b = 0; b < kBinCount; ++b) {
    right &= bins[b].begin % kLanes == 0 && bins[b].begin >= previous_end && bins[b].end >= bins[b].begin;
    right &= bins[b].begin - previous_end < kLanes;
    previous_end = bins[b].end;
    sorted += bins[b].size();
    uint32_t source = 0;  // stability: sources rise within a bin
    for (uint32_t i = bins[b].begin; i < bins[b].end; ++i) {
      while (source < n && !(from.state().slot[source] != capacity && from.state().bin[source] == b)) ++source;
      REQUIRE(source < n);
      const std::vector<uint32_t> want = kept_words(from.state(), source, share_t),
                                  got = kept_words(to.state(), i, share_t);
      const auto fields = b == kFinished ? kRetiredFields : std::ssize(want);
      right &= std::equal(want.begin(), want.begin() + fields, got.begin());
      ++source;
    }
    for (uint32_t i = bins[b].end; i < round_up_to_lanes(bins[b].end); ++i) {
      right &= to.state().slot[i] == capacity && to.state().beta_r[i] == 0 && to.state().d_z[i] == 1 &&
               to.state().c_r[i] == 0;
    }
  }
  CHECK(right);
  CHECK(sorted == real);
  CHECK(bins.dead == dead);
}

}  // namespace

TEST_CASE("sort: bins are contiguous, stable, padded and complete") {
  test::for_each_target([](const char* target) {
    CAPTURE(target);
    std::mt19937 rng(3);
    for (uint32_t n = 0; n <= 2 * kLanes; ++n)
      check_sort(n, [&](uint32_t) { return uint32_t(rng() % (kBinCount + 1)); });
    check_sort(1000, [&](uint32_t) { return uint32_t(rng() % (kBinCount + 1)); });
    check_sort(4096, [&](uint32_t i) { return i / 1024; });                                  // in order already
    check_sort(4096, [&](uint32_t i) { return 5 - i / 1024; });                              // in reverse
    for (uint32_t b = 0; b <= kBinCount; ++b) check_sort(333, [&](uint32_t) { return b; });  // all in one
    check_sort(
        1000, [&](uint32_t) { return uint32_t(rng() % (kBinCount + 1)); }, true);
    check_sort(997, [&](uint32_t i) { return i % 37 == 0 ? uint32_t{kGlass} : uint32_t{kDiffuse}; });
  });
}

}  // namespace lanewise
