#include "core/serve_rank.h"

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <numeric>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "core/light_film.h"
#include "core/local_draw.h"
#include "core/packed_sums.h"
#include "core/rank_messages.h"
#include "core/stats.h"

namespace lanewise {
namespace {

// Requests that wait for a thread.
class Inbox {
 public:
  void push(std::string request) {
    const std::lock_guard lock(mutex_);
    requests_.push_back(std::move(request));
    changed_.notify_one();
  }
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }
  // None: it is closed.
  std::optional<std::string> pop() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return closed_ || !requests_.empty(); });
    if (closed_) return std::nullopt;
    std::string request = std::move(requests_.front());
    requests_.pop_front();
    return request;
  }
  void wait_until_closed() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return closed_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::string> requests_;
  bool closed_ = false;
};

// The reply to a request; sums and slots are of this thread, to be used again.
std::string drawn(LocalDraw& local, const std::string& request, uint32_t worker, std::vector<PixelSums>& sums,
                  std::vector<uint32_t>& slots) {
  ByteReader in(request);
  const auto kind = in.get<MessageKind>();
  const auto desk = in.get<uint32_t>();
  if (kind == MessageKind::kDrawLight) {
    std::string packed;
    const auto pack_some = [&](Splats& splats) { packed += pack_splats(splats); };
    const Drawn took = local.draw_light(in.get<LightPiece>(), worker, pack_some);
    return message(MessageKind::kDrawn).put(desk).put(took).put(packed).take();
  }
  const auto first = in.get<uint64_t>();
  const auto count = in.get<uint32_t>();
  const std::vector<uint32_t> pixels = pixels_of(in.list<PixelRun>());
  sums.assign(pixels.size(), {});
  slots.resize(pixels.size());
  std::iota(slots.begin(), slots.end(), 0u);
  const Drawn took = local.draw(pixels, first, count, sums.data(), worker, slots.data());
  std::string packed;
  packed.reserve(sums.size() * sizeof(PixelSums) / 2);
  for (const PixelSums& s : sums) pack(s, packed);
  return message(MessageKind::kDrawn).put(desk).put(took).put(packed).take();
}

}  // namespace

void serve_rank(Messenger& messenger, const std::function<RankJob()>& load, ProfileDetail detail) {
  Inbox inbox;
  messenger.receive([&](uint32_t, std::string&& bytes) {
    const bool ends = kind_of(bytes) == MessageKind::kEnd;
    ends ? inbox.close() : inbox.push(std::move(bytes));
  });
  const auto carefully = [&](const auto& work) {
    try {
      work();
    } catch (const std::bad_alloc&) {
      messenger.send(0, message(MessageKind::kFailed).put(std::string("not enough memory")).take());
    } catch (const std::exception& e) {
      messenger.send(0, message(MessageKind::kFailed).put(std::string(e.what())).take());
    }
  };
  ByteWriter last = message(MessageKind::kProfile);
  carefully([&] {
    const RankJob job = load();
    const uint32_t threads = thread_count(job.plan.settings);
    ByteWriter ready = message(MessageKind::kReady);
    ready.put(threads);
    for (const auto& [name, value] : job.identity) ready.put(name).put(value);
    messenger.send(0, ready.take());

    LocalDraw local(job.plan, threads, detail);
    {
      std::vector<std::jthread> pool;
      for (uint32_t worker = 0; worker < threads; ++worker) {
        const auto work = [&, worker] {
          carefully([&] {
            std::vector<PixelSums> sums;
            std::vector<uint32_t> slots;
            while (const auto request = inbox.pop()) messenger.send(0, drawn(local, *request, worker, sums, slots));
          });
        };
        try {
          pool.emplace_back(work);
        } catch (const std::system_error&) {
          if (pool.empty()) throw;
          break;  // the machine gives no more
        }
      }
    }
    Profile all;
    for (const Profile& profile : local.profiles()) all.add(profile);
    put(last, all);
  });
  inbox.wait_until_closed();
  messenger.send(0, last.take());
}

}  // namespace lanewise
