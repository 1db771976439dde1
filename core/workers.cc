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
  pool.reserve(threads);
  try {
    while (pool.size() < threads) pool.emplace_back(work, static_cast<uint32_t>(pool.size()));
  } catch (const std::exception&) {
    // The machine gives no more, or has no memory for them: those that there are do the work, at worst this one alone.
    const std::lock_guard lock(mutex);
    running -= threads - static_cast<uint32_t>(std::max<size_t>(pool.size(), 1));
  }
  if (pool.empty()) work(0);
  try {
    std::unique_lock lock(mutex);
    while (!stopped.wait_for(lock, kBetweenReports, [&] { return running == 0; })) {
      lock.unlock();
      report();
      lock.lock();
    }
  } catch (...) {
    next = items;
    throw;
  }
  pool.clear();
  if (failure) std::rethrow_exception(failure);
  report();
}

void for_each_row(uint32_t threads, uint32_t rows, const std::function<void(uint32_t)>& body) {
  run_workers(
      threads, rows,
      [&](size_t row, uint32_t) {
        body(static_cast<uint32_t>(row));
        return uint64_t{0};
      },
      nullptr);
}

}  // namespace lanewise
