#include "core/zeroed_pages.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <new>
#include <vector>

namespace lanewise {
namespace {

using Zeros = ZeroedVector<uint32_t>;

bool is_zero(const Zeros& zeros, size_t end) {
  return std::ranges::all_of(zeros.begin(), zeros.begin() + static_cast<ptrdiff_t>(end),
                             [](uint32_t x) { return x == 0; });
}

}  // namespace

TEST_CASE("zeroed pages: small arrays and large ones are zero, and keep what is written to their ends") {
  for (const size_t size : {size_t{1}, size_t{1000}, size_t{1} << 17, (size_t{1} << 19) - 1, size_t{2} << 20,
                            (size_t{2} << 20) + 1, (size_t{3} << 20) - 1}) {
    CAPTURE(size);
    for (int again = 0; again < 3; ++again) {  // also where another has been
      Zeros zeros(size);
      REQUIRE(is_zero(zeros, size));
      REQUIRE(reinterpret_cast<uintptr_t>(zeros.data()) % 64 == 0);
      zeros.front() = 7, zeros.back() = 9;
      Zeros longer = zeros;
      longer.resize(size + 5);
      CHECK(longer[size - 1] == 9);
      CHECK(longer[size + 4] == 0);
      CHECK(longer.front() == (size == 1 ? 9 : 7));
      std::ranges::fill(zeros, ~0u);
    }
  }
}

TEST_CASE("zeroed pages: small arrays take what they are, large ones whole pages") {
  CHECK(paged_bytes(kHugePage / 4 - 1) == kHugePage / 4 - 1);
  CHECK(paged_bytes(kHugePage / 4) == kHugePage);
  CHECK(paged_bytes(kHugePage) == kHugePage);
  CHECK(paged_bytes(kHugePage + 1) == 2 * kHugePage);
}

TEST_CASE("zeroed pages: what cannot be had is bad_alloc") {
  CHECK_THROWS_AS(Zeros(size_t{1} << 58), std::bad_alloc);
  CHECK_THROWS_AS(ZeroedPages<uint32_t>().allocate(~size_t{0}), std::bad_alloc);
}

}  // namespace lanewise
