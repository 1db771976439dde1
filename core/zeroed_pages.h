// Memory of large arrays: zero without being written to, and of whole huge pages where the system has them. A page of 4 KiB costs a
// fault, which is dear on a virtual machine, and a render of few samples would touch thousands of them; one of 2 MiB costs little more.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace lanewise {

constexpr size_t kHugePage = size_t{2} << 20;

// Whether an array of that many bytes lies in huge pages of its own, and what it takes then: whole ones.
constexpr bool is_paged(size_t bytes) { return bytes >= kHugePage / 4; }
constexpr size_t paged_bytes(size_t bytes) {
  return is_paged(bytes) ? (bytes + kHugePage - 1) / kHugePage * kHugePage : bytes;
}

// An allocator of elements whose zero bytes are T{}, from a cache line on. What a thread is the first to touch is near it.
template <class T>
struct ZeroedPages {
  static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= alignof(std::max_align_t));
  using value_type = T;

  ZeroedPages() = default;
  template <class U>
  explicit constexpr ZeroedPages(const ZeroedPages<U>&) {}

  T* allocate(size_t n) {
    if (n > PTRDIFF_MAX / sizeof(T)) throw std::bad_array_new_length();
    const size_t bytes = n * sizeof(T);
    void* const memory =
        is_paged(bytes) ? map(paged_bytes(bytes)) : std::aligned_alloc(kLine, (bytes + kLine - 1) / kLine * kLine);
    if (!memory) throw std::bad_alloc();
    if (!is_paged(bytes)) std::memset(memory, 0, bytes);
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, size_t n) noexcept {
    const size_t bytes = n * sizeof(T);
    is_paged(bytes) ? void(munmap(memory, paged_bytes(bytes))) : std::free(memory);
  }

  template <class U>
  void construct(U*) {}
  template <class U, class... Values>
  void construct(U* place, Values&&... values) {
    ::new (place) U(std::forward<Values>(values)...);
  }
  bool operator==(const ZeroedPages&) const = default;

 private:
  static constexpr size_t kLine = 64;

  // From the start of a huge page on. What is cut off is never counted as memory in use.
  static void* map(size_t bytes) {
    void* const memory = mmap(nullptr, bytes + kHugePage, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) return nullptr;
    char* const all = static_cast<char*>(memory);
    const size_t before = -reinterpret_cast<uintptr_t>(all) % kHugePage;
    if (before > 0) munmap(all, before);
    munmap(all + before + bytes, kHugePage - before);
    if (mprotect(all + before, bytes, PROT_READ | PROT_WRITE) != 0) {
      munmap(all + before, bytes);
      return nullptr;
    }
    madvise(all + before, bytes, MADV_HUGEPAGE);  // no harm where it is refused
    return all + before;
  }
};

template <class T>
using ZeroedVector = std::vector<T, ZeroedPages<T>>;

}  // namespace lanewise
