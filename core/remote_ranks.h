// One render by several processes, its ranks. Each has the whole scene and compiles the same plan. Rank 0 alone has the film: it
// deals out pixels and sample numbers to its own threads and to the other ranks as they get free, and adds the sums that come back.
// Sums are exact, so the picture is the same bits whoever draws what.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "core/light_film.h"
#include "core/local_draw.h"
#include "core/messenger.h"
#include "core/profile.h"
#include "core/render.h"
#include "core/render_identity.h"

namespace lanewise {

// The other ranks, to rank 0.
class RemoteRanks {
 public:
  explicit RemoteRanks(Messenger& messenger);
  ~RemoteRanks();  // ends them
  RemoteRanks(const RemoteRanks&) = delete;
  RemoteRanks& operator=(const RemoteRanks&) = delete;

  // Waits until each has its plan. Throws Error, naming the rank, if one failed, or if its identity is another.
  void meet(const RenderIdentity& expected);

  // How many draws they can be asked for at a time: more than they have threads, so that none has to wait for the next.
  uint32_t workers() const { return static_cast<uint32_t>(desks_.size()); }
  // As LocalDraw::draw(), for worker < workers(): returns when it is done. Throws Error, naming the rank, if it fails.
  Drawn draw(const std::vector<uint32_t>& pixels, uint64_t first, uint32_t count, PixelSums* sums, uint32_t worker);

  // The same of light paths.
  Drawn draw_light(const LightPiece& piece, LightFilm& film, uint32_t worker);

  // Ends them: what each has counted, and then what is to be said of it. No draws after that.
  std::vector<Profile> profiles();
  std::vector<RankStats> stats() const;

 private:
  enum class State { kLoading, kReady, kEnded };
  struct Rank {
    State state = State::kLoading;
    uint32_t threads = 0;
    RenderIdentity identity;
    Profile profile;
    uint64_t sent = 0, received = 0;  // bytes, by it
  };
  // Where a draw's reply is waited for.
  struct Desk {
    explicit Desk(uint32_t rank_) : rank(rank_) {}

    uint32_t rank;
    bool waits = false;
    std::string reply;
    std::condition_variable changed;
  };

  // Sends the request from that desk, and waits for what comes back: the sums, packed.
  Drawn ask(uint32_t worker, std::string request, std::string& packed);
  void handle(uint32_t from, std::string&& bytes);
  void take(uint32_t from, Rank& rank, std::string&& bytes);  // with mutex_ held
  void send(uint32_t to, std::string bytes);                  // with mutex_ held
  void fail(const std::string& why);                          // the same
  void end();

  Messenger& messenger_;
  mutable std::mutex mutex_;         // guards what follows
  std::condition_variable changed_;  // a rank's state, or failure_
  std::map<uint32_t, Rank> ranks_;
  std::deque<Desk> desks_;
  std::string failure_;
  bool ended_ = false;
};

}  // namespace lanewise
