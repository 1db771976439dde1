#include "core/mpi_messenger.h"

#include <charconv>
#include <climits>
#include <cstdlib>
#include <cstring>

#include "core/types.h"

#ifdef LANEWISE_MPI
#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>
#endif

namespace lanewise {
namespace {

// Of the first of these variables that there is.
uint32_t variable(std::initializer_list<const char*> names, uint32_t otherwise) {
  for (const char* name : names) {
    const char* text = std::getenv(name);
    uint32_t value = 0;
    if (text && std::from_chars(text, text + std::strlen(text), value).ec == std::errc()) return value;
  }
  return otherwise;
}

// As Open MPI says, or the process managers of MPICH and Slurm; where Slurm starts Open MPI's by PMIx, it alone knows how many.
uint32_t launched_ranks() {
  const uint32_t by_pmix = std::getenv("PMIX_RANK") ? variable({"SLURM_NTASKS"}, 1) : 1;
  return variable({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}, by_pmix);
}

#ifdef LANEWISE_MPI
// All calls of MPI while it lives are of one thread, which looks for what has come, and sends what others leave with it.
class MpiMessenger : public Messenger {
 public:
  MpiMessenger() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
    if (provided < MPI_THREAD_SERIALIZED) throw Error("MPI: it is built without threads (MPI_THREAD_SERIALIZED)");
    int rank = 0, ranks = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    rank_ = static_cast<uint32_t>(rank);
    ranks_ = static_cast<uint32_t>(ranks);
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }
  ~MpiMessenger() override {
    thread_.request_stop();
    thread_.join();
    MPI_Finalize();
  }

  uint32_t rank() const override { return rank_; }
  uint32_t ranks() const override { return ranks_; }
  void send(uint32_t to, std::string bytes) override {
    // A tile is far from it: the pixels of the largest wave are some 100 MB.
    if (bytes.size() > INT_MAX) throw Error("MPI: a message of more than 2 GiB");
    const std::lock_guard lock(mutex_);
    outbox_.emplace_back(to, std::move(bytes));
    changed_.notify_one();
  }
  void receive(std::function<void(uint32_t, std::string&&)> handle) override {
    const std::lock_guard lock(mutex_);
    handle_ = std::move(handle);
    changed_.notify_one();
  }

 private:
  // A message on its way, which MPI reads where it is.
  struct Sending {
    std::string bytes;
    MPI_Request request = MPI_REQUEST_NULL;
  };

  void run(const std::stop_token& stop) {
    using namespace std::chrono_literals;
    // Between two looks: MPI has no way to wait without burning a core.
    constexpr auto kShortest = 20us, kLongest = 500us;
    auto pause = kShortest;
    std::deque<Sending> sending;  // does not move what it holds
    for (;;) {
      bool any = send_all(sending);
      any |= receive_one();
      while (!sending.empty() && is_done(sending.front())) sending.pop_front();
      std::unique_lock lock(mutex_);
      if (stop.stop_requested() && outbox_.empty() && sending.empty()) return;
      pause = any ? kShortest : std::min<std::chrono::microseconds>(2 * pause, kLongest);
      if (!any) changed_.wait_for(lock, pause, [&] { return !outbox_.empty(); });
    }
  }

  bool send_all(std::deque<Sending>& sending) {
    std::deque<std::pair<uint32_t, std::string>> outbox;
    {
      const std::lock_guard lock(mutex_);
      outbox.swap(outbox_);
    }
    for (auto& [to, bytes] : outbox) {
      Sending& message = sending.emplace_back(Sending{.bytes = std::move(bytes)});
      MPI_Isend(message.bytes.data(), static_cast<int>(message.bytes.size()), MPI_BYTE, static_cast<int>(to), 0,
                MPI_COMM_WORLD, &message.request);
    }
    return !outbox.empty();
  }

  bool receive_one() {
    std::function<void(uint32_t, std::string &&)> handle;
    {
      const std::lock_guard lock(mutex_);
      handle = handle_;
    }
    int there = 0, size = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, 0, MPI_COMM_WORLD, &there, &status);
    if (!there || !handle) return false;
    MPI_Get_count(&status, MPI_BYTE, &size);
    std::string bytes(static_cast<size_t>(size), '\0');
    MPI_Recv(bytes.data(), size, MPI_BYTE, status.MPI_SOURCE, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    handle(static_cast<uint32_t>(status.MPI_SOURCE), std::move(bytes));
    return true;
  }

  static bool is_done(Sending& message) {
    int done = 0;
    MPI_Test(&message.request, &done, MPI_STATUS_IGNORE);
    return done != 0;
  }

  uint32_t rank_ = 0, ranks_ = 1;
  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  std::deque<std::pair<uint32_t, std::string>> outbox_;
  std::function<void(uint32_t, std::string&&)> handle_;
  std::jthread thread_;
};
#endif

}  // namespace

bool is_launched() { return launched_ranks() > 1; }

std::string mpi_library() {
#ifdef LANEWISE_MPI
  char text[MPI_MAX_LIBRARY_VERSION_STRING];
  int size = 0;
  MPI_Get_library_version(text, &size);
  const std::string all(text, static_cast<size_t>(size));
  return all.substr(0, all.find(','));  // then comes who has packaged it
#else
  return "";
#endif
}

std::unique_ptr<Messenger> mpi_messenger() {
  if (!is_launched()) return nullptr;
#ifdef LANEWISE_MPI
  return std::make_unique<MpiMessenger>();
#else
  throw Error("mpirun has started several processes, but this program is built without MPI");
#endif
}

}  // namespace lanewise
