// Memory of large arrays: zero without being written to, and of huge pages where the system has them. A page of 4 KiB costs a
// fault, and a render of few samples touches thousands of them; one of 2 MiB costs as much.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <type_traits>
#include <utility>

namespace lanewise {

// An allocator of elements whose zero bytes are T{}. What a thread is the first to touch is near it.
template <class T>
struct ZeroedPages {
  static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= alignof(std::max_align_t));
  using value_type = T;

  ZeroedPages() = default;
  template <class U>
  explicit constexpr ZeroedPages(const ZeroedPages<U>&) {}

  T* allocate(size_t n) {
    if (n > PTRDIFF_MAX / sizeof(T)) throw std::bad_array_new_length();
    void* memory = is_large(n) ? map(n * sizeof(T)) : std::calloc(n, sizeof(T));
    if (!memory) throw std::bad_alloc();
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, size_t n) noexcept {
    is_large(n) ? void(munmap(memory, n * sizeof(T))) : std::free(memory);
  }

  template <class U>
  void construct(U*) {}
  template <class U, class... Values>
  void construct(U* place, Values&&... values) {
    ::new (place) U(std::forward<Values>(values)...);
  }
  bool operator==(const ZeroedPages&) const = default;

 private:
  static constexpr size_t kHugePage = size_t{2} << 20;
  static bool is_large(size_t n) { return n * sizeof(T) >= 4 * kHugePage; }

  // From the start of a huge page on.
  static void* map(size_t bytes) {
    const size_t more = bytes + kHugePage;
    void* const memory = mmap(nullptr, more, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) return nullptr;
    char* const begin = static_cast<char*>(memory);
    const size_t before = -reinterpret_cast<uintptr_t>(begin) % kHugePage;
    constexpr size_t kPage = 4096;
    const size_t end = (before + bytes + kPage - 1) / kPage * kPage;
    if (before > 0) munmap(begin, before);
    if (end < more) munmap(begin + end, more - end);
    madvise(begin + before, bytes, MADV_HUGEPAGE);  // no harm where it is refused
    return begin + before;
  }
};

}  // namespace lanewise
