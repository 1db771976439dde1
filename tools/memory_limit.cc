#include "tools/memory_limit.h"

#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <functional>
#include <new>
#include <system_error>

#include "core/explain.h"
#include "core/stats.h"
#include "core/types.h"

namespace lanewise {
namespace {

// Whose own data, terabytes of addresses, are none of the render's.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kIsSanitized = true;
#else
constexpr bool kIsSanitized = false;
#endif

uint64_t held_to = 0;

// Rounded up: a limit of what is said to be needed is enough.
std::string size_text(uint64_t bytes) {
  const uint64_t megabytes = (bytes + (1u << 20) - 1) >> 20;
  return std::to_string(megabytes) + "M";
}

// What the program has taken of what is held.
uint64_t data_bytes() {
  if (kIsSanitized) return 0;
  uint64_t all, resident, shared, text, libraries, data = 0;  // pages
  std::ifstream("/proc/self/statm") >> all >> resident >> shared >> text >> libraries >> data;
  return data * static_cast<uint64_t>(::sysconf(_SC_PAGESIZE));
}

// Of a thread.
uint64_t stack_bytes() {
  pthread_attr_t attributes;
  size_t bytes = 0;
  if (::pthread_getattr_default_np(&attributes) != 0) return bytes;
  ::pthread_attr_getstacksize(&attributes, &bytes);
  ::pthread_attr_destroy(&attributes);
  return bytes;
}

struct Share {
  const char* name;
  uint64_t bytes;
  const char* mend;
};

}  // namespace

void hold_memory_to(uint64_t bytes) {
  if (bytes == 0) return;
  held_to = bytes;
  if (kIsSanitized) return;
  // Of data rather than of addresses: those that the allocator reserves, and the libraries' code, are no memory that is taken.
  rlimit limit{};
  ::getrlimit(RLIMIT_DATA, &limit);
  limit.rlim_cur = std::min<rlim_t>({bytes, limit.rlim_cur, limit.rlim_max});
  if (::setrlimit(RLIMIT_DATA, &limit) != 0) {
    throw Error("--max-memory: " + std::generic_category().message(errno));
  }
}

void check_memory(const RenderOptions& o, const Plan& plan) {
  if (o.max_memory == 0) return;
  const MemoryNeed need = memory_need(plan, o.is_part() || !o.checkpoint.empty());
  const uint64_t threads = thread_count(plan.settings);
  std::array<Share, 4> shares = {
      {{"the film", need.film, "a smaller --resolution (-r)"},
       {"threads", need.paths + threads * stack_bytes(), "fewer --threads (-t)"},
       {"files", need.files, "a smaller --resolution (-r)"},
       {"the scene and the program", std::max<uint64_t>(data_bytes(), need.scene), "a smaller scene"}}};
  uint64_t all = 0;
  for (const Share& share : shares) all += share.bytes;
  if (all <= o.max_memory) return;
  std::ranges::sort(shares, std::greater(), &Share::bytes);
  std::string text;
  for (const Share& share : shares) text += (text.empty() ? "" : ", ") + size_text(share.bytes) + " for " + share.name;
  throw Error("--max-memory: the render needs " + size_text(all) + ", more than " + size_text(o.max_memory) + ": " +
              text + "; " + shares[0].mend + " needs less");
}

bool is_of_memory(const std::exception& failure) {
  if (dynamic_cast<const std::bad_alloc*>(&failure)) return true;
  if (dynamic_cast<const Error*>(&failure)) return false;
  return std::string(failure.what()).find(std::generic_category().message(ENOMEM)) != std::string::npos;
}

std::string memory_complaint() {
  return held_to > 0 ? "not enough memory within --max-memory, " + size_text(held_to) : "not enough memory";
}

}  // namespace lanewise
