// The few types that every part of the renderer shares.
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace lanewise {

// Vector granularity of all state: 16 floats, one 64-byte cache line, one AVX-512 vector. A range begins at a multiple
// of it, and a kernel may read and write up to the range's end rounded up to it.
constexpr uint32_t kLanes = 16;

constexpr uint32_t round_up_to_lanes(uint32_t n) { return (n + kLanes - 1) / kLanes * kLanes; }

// Slots [begin, end) of a PathState; begin is a multiple of kLanes.
struct Range {
  uint32_t begin = 0;
  uint32_t end = 0;

  uint32_t size() const { return end - begin; }
  bool empty() const { return begin == end; }
};

// Something that the user can mend: a file, a flag, the machine. what() is one line that names it and says what is
// wrong. Caught once, in main.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Thrown for wrong command lines (exit code 2) rather than wrong files (exit code 1).
struct UsageError : Error {
  using Error::Error;
};

template <class T>
struct CacheLineAllocator {
  using value_type = T;
  static constexpr std::align_val_t kAlign{64};

  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U>&) {}

  T* allocate(size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), kAlign)); }
  void deallocate(T* p, size_t) { ::operator delete(p, kAlign); }
  bool operator==(const CacheLineAllocator&) const { return true; }
};

// A vector whose data starts on a cache line, so that aligned vector loads are allowed.
template <class T>
using AlignedVector = std::vector<T, CacheLineAllocator<T>>;

}  // namespace lanewise
