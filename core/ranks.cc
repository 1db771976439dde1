#include "core/ranks.h"

#include <algorithm>
#include <deque>
#include <exception>
#include <numeric>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "core/bytes.h"
#include "core/packed_sums.h"
#include "core/stats.h"
#include "core/types.h"

namespace lanewise {
namespace {

// The first byte of a message.
enum class Kind : uint8_t {
  kReady,   // to rank 0: threads, identity
  kFailed,  // to rank 0: why
  kDraw,    // to another: desk, first sample, count, pixels as runs
  kDrawn,   // to rank 0: desk, Drawn, each pixel's sums
  kEnd,     // to another
  kProfile  // to rank 0, the last: what it counted, nothing if it failed
};

ByteWriter message(Kind kind) {
  ByteWriter out;
  out.put(kind);
  return out;
}

Kind kind_of(const std::string& bytes) { return static_cast<Kind>(bytes.at(0)); }

// Pixels that follow each other, as most of a tile's do.
struct Run {
  uint32_t first, count;
};

std::vector<Run> runs_of(const std::vector<uint32_t>& pixels) {
  std::vector<Run> runs;
  for (const uint32_t pixel : pixels) {
    if (!runs.empty() && runs.back().first + runs.back().count == pixel) {
      ++runs.back().count;
    } else {
      runs.push_back({pixel, 1});
    }
  }
  return runs;
}

std::vector<uint32_t> pixels_of(const std::vector<Run>& runs) {
  std::vector<uint32_t> pixels;
  for (const Run& run : runs) {
    for (uint32_t i = 0; i < run.count; ++i) pixels.push_back(run.first + i);
  }
  return pixels;
}

// Without the stages that did not run.
void put(ByteWriter& out, const Profile& profile) {
  out.put(static_cast<uint32_t>(profile.bounces.size()));
  for (const auto& stages : profile.bounces) {
    for (const StageCounter& counter : stages) {
      const bool ran = counter.calls > 0 || counter.rays > 0;
      out.put(ran);
      if (ran) out.put(counter);
    }
  }
  out.put(profile.paths_by_length);
  for (const uint64_t n : {profile.waves, profile.calm_waves, profile.wave_nanoseconds, profile.calm_wave_nanoseconds,
                           profile.samples, profile.bounce_rays, profile.shadow_rays, profile.invalid_samples}) {
    out.put(n);
  }
}

Profile get_profile(ByteReader& in) {
  Profile profile;
  for (auto bounces = in.get<uint32_t>(); bounces > 0; --bounces) {
    for (StageCounter& counter : profile.bounces.emplace_back()) {
      if (in.get<bool>()) counter = in.get<StageCounter>();
    }
  }
  profile.paths_by_length = in.list<uint64_t>();
  for (uint64_t* n : {&profile.waves, &profile.calm_waves, &profile.wave_nanoseconds, &profile.calm_wave_nanoseconds,
                      &profile.samples, &profile.bounce_rays, &profile.shadow_rays, &profile.invalid_samples}) {
    *n = in.get<uint64_t>();
  }
  return profile;
}

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
  in.get<Kind>();
  const auto desk = in.get<uint32_t>();
  const auto first = in.get<uint64_t>();
  const auto count = in.get<uint32_t>();
  const std::vector<uint32_t> pixels = pixels_of(in.list<Run>());
  sums.assign(pixels.size(), {});
  slots.resize(pixels.size());
  std::iota(slots.begin(), slots.end(), 0u);
  const Drawn took = local.draw(pixels, first, count, sums.data(), worker, slots.data());
  std::string packed;
  packed.reserve(sums.size() * sizeof(PixelSums) / 2);
  for (const PixelSums& s : sums) pack(s, packed);
  return message(Kind::kDrawn).put(desk).put(took).put(packed).take();
}

}  // namespace

void serve(Messenger& messenger, const std::function<RankJob()>& load, ProfileDetail detail) {
  Inbox inbox;
  messenger.receive([&](uint32_t, std::string&& bytes) {
    const bool ends = kind_of(bytes) == Kind::kEnd;
    ends ? inbox.close() : inbox.push(std::move(bytes));
  });
  const auto carefully = [&](const auto& work) {
    try {
      work();
    } catch (const std::bad_alloc&) {
      messenger.send(0, message(Kind::kFailed).put(std::string("not enough memory")).take());
    } catch (const std::exception& e) {
      messenger.send(0, message(Kind::kFailed).put(std::string(e.what())).take());
    }
  };
  ByteWriter last = message(Kind::kProfile);
  carefully([&] {
    const RankJob job = load();
    const uint32_t threads = thread_count(job.plan.settings);
    ByteWriter ready = message(Kind::kReady);
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

RemoteRanks::RemoteRanks(Messenger& messenger) : messenger_(messenger) {
  for (uint32_t rank = 1; rank < messenger.ranks(); ++rank) ranks_[rank];
  messenger.receive([this](uint32_t from, std::string&& bytes) { handle(from, std::move(bytes)); });
}

RemoteRanks::~RemoteRanks() { end(); }

void RemoteRanks::meet(const RenderIdentity& expected) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] {
    return !failure_.empty() ||
           std::ranges::all_of(ranks_, [](const auto& rank) { return rank.second.state == State::kReady; });
  });
  if (!failure_.empty()) throw Error(failure_);
  std::vector<std::pair<uint32_t, uint32_t>> desks;  // turn, rank
  for (const auto& [number, rank] : ranks_) {
    const std::string d = difference(expected, rank.identity);
    if (!d.empty()) throw Error("rank " + std::to_string(number) + ": would draw another picture: " + d);
    // Some more than threads: a message is on its way for as long as a thread takes for a few rows.
    for (uint32_t i = 0; i < rank.threads + 1 + rank.threads / 8; ++i) desks.emplace_back(i, number);
  }
  // One each, then another each, so that few tiles are dealt out to many ranks.
  std::ranges::sort(desks);
  for (const auto& [turn, number] : desks) desks_.emplace_back(number);
}

Drawn RemoteRanks::draw(const std::vector<uint32_t>& pixels, uint64_t first, uint32_t count, PixelSums* sums,
                        uint32_t worker) {
  std::string request = message(Kind::kDraw).put(worker).put(first).put(count).put(runs_of(pixels)).take();
  std::string reply;
  {
    std::unique_lock lock(mutex_);
    Desk& desk = desks_[worker];
    desk.waits = true;
    send(desk.rank, std::move(request));
    desk.changed.wait(lock, [&] { return !desk.waits || !failure_.empty(); });
    if (desk.waits) throw Error(failure_);
    reply = std::move(desk.reply);
  }
  ByteReader in(reply);
  in.get<Kind>();
  in.get<uint32_t>();
  const auto took = in.get<Drawn>();
  const std::string packed = in.text();
  ByteReader packed_sums(packed);
  for (const uint32_t pixel : pixels) sums[pixel] += unpack_sums(packed_sums);
  return took;
}

std::vector<Profile> RemoteRanks::profiles() {
  end();
  if (!failure_.empty()) throw Error(failure_);
  std::vector<Profile> all;
  for (const auto& [number, rank] : ranks_) all.push_back(rank.profile);
  return all;
}

std::vector<RankStats> RemoteRanks::stats() const {
  std::vector<RankStats> stats;
  for (const auto& [number, rank] : ranks_) {
    stats.push_back({number, rank.threads, rank.profile.samples, rank.sent, rank.received});
  }
  return stats;
}

void RemoteRanks::send(uint32_t to, std::string bytes) {
  ranks_[to].received += bytes.size();
  messenger_.send(to, std::move(bytes));
}

void RemoteRanks::fail(const std::string& why) {
  if (failure_.empty()) failure_ = why;
  for (Desk& desk : desks_) desk.changed.notify_one();
}

void RemoteRanks::end() {
  std::unique_lock lock(mutex_);
  if (!std::exchange(ended_, true)) {
    for (const auto& [number, rank] : ranks_) send(number, message(Kind::kEnd).take());
  }
  changed_.wait(lock, [&] {
    return std::ranges::all_of(ranks_, [](const auto& rank) { return rank.second.state == State::kEnded; });
  });
}

void RemoteRanks::handle(uint32_t from, std::string&& bytes) {
  const std::lock_guard lock(mutex_);
  Rank& rank = ranks_[from];
  rank.sent += bytes.size();
  try {
    take(from, rank, std::move(bytes));
  } catch (const std::exception& e) {
    fail("rank " + std::to_string(from) + ": " + e.what());
  }
  changed_.notify_all();
}

void RemoteRanks::take(uint32_t from, Rank& rank, std::string&& bytes) {
  ByteReader in(bytes);
  switch (in.get<Kind>()) {
    case Kind::kReady:
      rank.state = State::kReady;
      rank.threads = in.get<uint32_t>();
      while (!in.empty()) {
        std::string name = in.text();
        rank.identity.emplace_back(std::move(name), in.text());
      }
      break;
    case Kind::kFailed:
      fail("rank " + std::to_string(from) + ": " + in.text());
      break;
    case Kind::kDrawn: {
      Desk& desk = desks_.at(in.get<uint32_t>());
      desk.reply = std::move(bytes);
      desk.waits = false;
      desk.changed.notify_one();
      break;
    }
    case Kind::kProfile:
      rank.state = State::kEnded;
      if (!in.empty()) rank.profile = get_profile(in);
      break;
    case Kind::kDraw:
    case Kind::kEnd:
      break;
  }
}

}  // namespace lanewise
