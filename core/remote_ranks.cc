#include "core/remote_ranks.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "core/packed_sums.h"
#include "core/rank_messages.h"
#include "core/types.h"

namespace lanewise {

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
  std::string packed;
  const Drawn took =
      ask(worker, message(MessageKind::kDraw).put(worker).put(first).put(count).put(runs_of(pixels)).take(), packed);
  ByteReader packed_sums(packed);
  for (const uint32_t pixel : pixels) sums[pixel] += unpack_sums(packed_sums);
  return took;
}

Drawn RemoteRanks::draw_light(const LightPiece& piece, LightFilm& film, uint32_t worker) {
  std::string packed;
  const Drawn took = ask(worker, message(MessageKind::kDrawLight).put(worker).put(piece).take(), packed);
  ByteReader packed_sums(packed);
  film.add(packed_sums);
  return took;
}

Drawn RemoteRanks::ask(uint32_t worker, std::string request, std::string& packed) {
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
  in.get<MessageKind>();
  in.get<uint32_t>();
  const auto took = in.get<Drawn>();
  packed = in.text();
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
    for (const auto& [number, rank] : ranks_) send(number, message(MessageKind::kEnd).take());
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
  switch (in.get<MessageKind>()) {
    case MessageKind::kReady:
      rank.state = State::kReady;
      rank.threads = in.get<uint32_t>();
      while (!in.empty()) {
        std::string name = in.text();
        rank.identity.emplace_back(std::move(name), in.text());
      }
      break;
    case MessageKind::kFailed:
      fail("rank " + std::to_string(from) + ": " + in.text());
      break;
    case MessageKind::kDrawn: {
      Desk& desk = desks_.at(in.get<uint32_t>());
      desk.reply = std::move(bytes);
      desk.waits = false;
      desk.changed.notify_one();
      break;
    }
    case MessageKind::kProfile:
      rank.state = State::kEnded;
      if (!in.empty()) rank.profile = get_profile(in);
      break;
    case MessageKind::kDraw:
    case MessageKind::kDrawLight:
    case MessageKind::kEnd:
      break;
  }
}

}  // namespace lanewise
