#include "core/workers.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace lanewise {

void run_workers(uint32_t threads, size_t items, const std::function<uint64_t(size_t, uint32_t)>& body,
                 const std::function<void(const Progress&)>& progress) {
  constexpr auto kBetweenReports = std::chrono::milliseconds(100);
  threads = static_cast<uint32_t>(std::clamp<size_t>(items, 1, threads));
  std::atomic<size_t> next{0}, done{0};
  std::atomic<uint64_t> rays{0};
  std::mutex mutex;  // guards the two below
  std::condition_variable stopped;
  uint32_t running = threads;
  std::exception_ptr failure;

  const auto work = [&](uint32_t worker) {
    try {
      for (size_t item; (item = next.fetch_add(1)) < items;) {
        rays.fetch_add(body(item, worker), std::memory_order_relaxed);
        done.fetch_add(1, std::memory_order_relaxed);
      }
    } catch (...) {
      next = items;
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    --running;
    stopped.notify_one();
  };

  const auto start = std::chrono::steady_clock::now();
  const auto report = [&] {
    if (!progress) return;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    progress({items > 0 ? static_cast<double>(done) / static_cast<double>(items) : 1, rays, elapsed.count()});
  };

  std::vector<std::jthread> pool;
  for (uint32_t worker = 0; worker < threads; ++worker) pool.emplace_back(work, worker);
  {
    std::unique_lock lock(mutex);
    while (!stopped.wait_for(lock, kBetweenReports, [&] { return running == 0; })) {
      lock.unlock();
      report();
      lock.lock();
    }
  }
  pool.clear();
  if (failure) std::rethrow_exception(failure);
  report();
}

}  // namespace lanewise
