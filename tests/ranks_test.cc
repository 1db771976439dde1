// Several ranks draw the bits of one: here as threads of one process, and by mpirun where there is MPI.
#include <doctest/doctest.h>

#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "core/bytes.h"
#include "core/mpi_messenger.h"
#include "core/packed_sums.h"
#include "core/plan.h"
#include "core/remote_ranks.h"
#include "core/render.h"
#include "core/serve_rank.h"
#include "core/verify/test_scene.h"
#include "tests/program.h"
#include "tests/subprocess.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

// Ranks in one process: each message goes to a queue, from which a thread takes it.
class Post {
 public:
  explicit Post(uint32_t ranks) {
    for (uint32_t rank = 0; rank < ranks; ++rank) doors_.push_back(std::make_unique<Door>(*this, rank));
  }
  Messenger& operator[](uint32_t rank) { return *doors_[rank]; }

 private:
  class Door : public Messenger {
   public:
    Door(Post& post, uint32_t rank)
        : post_(post), rank_(rank), thread_([this](const std::stop_token& stop) { deliver(stop); }) {}

    uint32_t rank() const override { return rank_; }
    uint32_t ranks() const override { return static_cast<uint32_t>(post_.doors_.size()); }
    void send(uint32_t to, std::string bytes) override { post_.doors_[to]->take(rank_, std::move(bytes)); }
    void receive(std::function<void(uint32_t, std::string&&)> handle) override {
      const std::lock_guard lock(mutex_);
      handle_ = std::move(handle);
      changed_.notify_all();
    }

   private:
    void take(uint32_t from, std::string bytes) {
      const std::lock_guard lock(mutex_);
      waiting_.emplace_back(from, std::move(bytes));
      changed_.notify_all();
    }
    void deliver(const std::stop_token& stop) {
      for (;;) {
        std::unique_lock lock(mutex_);
        if (!changed_.wait(lock, stop, [&] { return handle_ && !waiting_.empty(); })) return;
        auto [from, bytes] = std::move(waiting_.front());
        waiting_.pop_front();
        lock.unlock();
        handle_(from, std::move(bytes));
      }
    }

    Post& post_;
    uint32_t rank_;
    std::mutex mutex_;
    std::condition_variable_any changed_;
    std::deque<std::pair<uint32_t, std::string>> waiting_;
    std::function<void(uint32_t, std::string&&)> handle_;
    std::jthread thread_;
  };

  std::vector<std::unique_ptr<Door>> doors_;
};

Settings small() {
  Settings settings;
  settings.width = 48, settings.height = 28, settings.threads = 1, settings.wave = 256;
  settings.estimate_error = true;
  return settings;
}

std::vector<Settings> modes() {
  Settings rounds = small(), adaptive = small(), to_noise = small();
  rounds.spp = 100;
  adaptive.spp = 128, adaptive.adaptive_batch = 16, adaptive.adaptive_tolerance = 0.1;
  to_noise.spp = 256, to_noise.noise = 0.1, to_noise.crop = {8, 6, 30, 20};
  return {rounds, adaptive, to_noise};
}

const RenderIdentity kIdentity = {{"scene", "1"}};

RankJob job(Settings settings, uint32_t rank) {
  settings.threads = 1 + rank % 2;
  settings.wave = rank % 3 == 0 ? 1024 : 256;
  return {make_plan(test::test_scene(), settings), kIdentity};
}

// Renders on so many ranks; load(rank): what the others load.
RenderResult render_on(uint32_t ranks, const Settings& settings, const std::function<RankJob(uint32_t)>& load) {
  Post post(ranks);
  std::vector<std::jthread> others;
  for (uint32_t rank = 1; rank < ranks; ++rank) {
    others.emplace_back([&, rank] { serve_rank(post[rank], [&] { return load(rank); }); });
  }
  RemoteRanks remote(post[0]);
  remote.meet(kIdentity);
  return render(make_plan(test::test_scene(), settings), {.remote = &remote});
}

void check_same(const RenderResult& got, const RenderResult& want) {
  CHECK(got.image.rgb == want.image.rgb);
  CHECK(got.samples == want.samples);
  CHECK(got.stats.camera_rays == want.stats.camera_rays);
  CHECK(got.stats.bounce_rays == want.stats.bounce_rays);
  CHECK(got.stats.shadow_rays == want.stats.shadow_rays);
  CHECK(got.stats.paths_by_length == want.stats.paths_by_length);
  CHECK(got.stats.invalid_samples == want.stats.invalid_samples);
  for (size_t i = 0; i < want.stats.stages.size(); ++i) {
    CHECK(got.stats.stages[i].name == want.stats.stages[i].name);
    CHECK(got.stats.stages[i].paths == want.stats.stages[i].paths);
  }
  CHECK(got.stats.converged == want.stats.converged);
  REQUIRE(got.stats.error.has_value() == want.stats.error.has_value());
  if (want.stats.error) CHECK(got.stats.error->mrse == want.stats.error->mrse);
}

std::string why_not(const std::function<void()>& f) {
  try {
    f();
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("ranks: 1, 2, 3, 4 and 8 of them draw the bits of one process, in every mode") {
  for (const Settings& settings : modes()) {
    const RenderResult want = render(make_plan(test::test_scene(), settings));
    for (const uint32_t ranks : {1u, 2u, 3u, 4u, 8u}) {
      CAPTURE(ranks);
      const RenderResult got = render_on(ranks, settings, [&](uint32_t rank) { return job(settings, rank); });
      check_same(got, want);
      REQUIRE(got.stats.ranks.size() == ranks);
      uint64_t samples = 0;
      for (uint32_t rank = 0; rank < ranks; ++rank) {
        const RankStats& stats = got.stats.ranks[rank];
        CHECK(stats.rank == rank);
        CHECK((stats.bytes_sent > 0) == (rank > 0));
        samples += stats.samples;
      }
      CHECK(samples == want.stats.samples);
    }
  }
}

TEST_CASE("ranks: stopped and resumed with other ranks, the same bits") {
  const Settings settings = modes()[0];
  const RenderResult want = render(make_plan(test::test_scene(), settings));
  SavedRender state;
  bool begun = false, stopped = true;
  int stops = 0;
  for (uint32_t ranks = 2; stopped && ranks < 100; ++ranks) {
    Post post(ranks % 3 + 1);
    std::vector<std::jthread> others;
    for (uint32_t rank = 1; rank < ranks % 3 + 1; ++rank) {
      others.emplace_back([&, rank] { serve_rank(post[rank], [&] { return job(settings, rank); }); });
    }
    RemoteRanks remote(post[0]);
    remote.meet(kIdentity);
    std::atomic<int> asked{0};
    SavedRender after;
    const RenderResult got =
        render(make_plan(test::test_scene(), settings), {.stop = [&] { return ++asked > 5; },
                                                         .resume = begun ? &state : nullptr,
                                                         .save = [&](SavedRender&& saved) { after = std::move(saved); },
                                                         .remote = &remote});
    state = std::move(after);
    begun = true;
    stopped = got.stats.stopped;
    stops += stopped;
    if (!stopped) CHECK(got.image.rgb == want.image.rgb);
  }
  CHECK_FALSE(stopped);
  CHECK(stops > 1);
}

TEST_CASE("ranks: one that fails, or would draw something else, ends the render with its reason") {
  const Settings settings = modes()[0];
  CHECK(why_not([&] {
          render_on(3, settings, [&](uint32_t rank) -> RankJob {
            if (rank == 2) throw Error("box.dae: cannot open");
            return job(settings, rank);
          });
        }) == "rank 2: box.dae: cannot open");
  CHECK(why_not([&] {
          render_on(3, settings, [&](uint32_t rank) {
            RankJob other = job(settings, rank);
            if (rank == 1) other.identity = {{"scene", "2"}};
            return other;
          });
        }).starts_with("rank 1: would draw another picture: of another scene"));
}

TEST_CASE("ranks: what is thrown on a thread of another rank ends the render, too") {
  const Settings settings = modes()[0];
  Post post(2);
  const std::jthread other([&] { serve_rank(post[1], [&] { return job(settings, 1); }); });
  RemoteRanks remote(post[0]);
  post[0].send(1, "\2");  // a request without an end
  CHECK(why_not([&] {
          remote.meet(kIdentity);
          render(make_plan(test::test_scene(), settings), {.remote = &remote});
        }) == "rank 1: a message ends early");
}

TEST_CASE("ranks: sums are the same after they are packed, whatever they are, and take less room") {
  std::mt19937_64 rng(1);
  std::string packed;
  std::vector<Uint128> want = {0, 1, 255, 256, ~Uint128{0}, Uint128{1} << 127, Uint128{255} << 120, Uint128{1} << 64};
  for (int i = 0; i < 10000; ++i) {
    want.push_back((Uint128{rng()} << 64 | rng()) >> (rng() % 128));
    want.push_back((Uint128{rng()} << 64 | rng()) << (rng() % 128));
  }
  for (const Uint128 units : want) pack(units, packed);
  ByteReader in(packed);
  for (const Uint128 units : want) REQUIRE(unpack(in) == units);
  CHECK(in.empty());
  CHECK_THROWS(unpack(in));

  packed.clear();
  constexpr int kPixels = 1000, kSamples = 64;
  std::uniform_real_distribution<float> radiance(0.01f, 2);
  for (int p = 0; p < kPixels; ++p) {
    PixelSums sums;
    for (int i = 0; i < kSamples; ++i) sums.add(radiance(rng), radiance(rng), radiance(rng));
    std::string one;
    pack(sums, one);
    ByteReader back(one);
    REQUIRE(unpack_sums(back) == sums);
    packed += one;
  }
  CHECK(packed.size() < kPixels * sizeof(PixelSums) * 55 / 100);
}

namespace {

bool no_mpi() {
  if (test::nothing_to_test()) return true;
  if (!mpi_library().empty() && std::filesystem::exists("/usr/bin/mpirun")) return false;
  MESSAGE("skipped: no MPI");
  return true;
}

// For the shell. MPI itself leaks.
std::string mpirun(uint32_t ranks) {
  return "timeout 55 mpirun --allow-run-as-root --oversubscribe -x ASAN_OPTIONS=detect_leaks=0 -n " +
         std::to_string(ranks) + " ";
}

}  // namespace

TEST_CASE("mpirun: a picture is that of one process") {
  if (no_mpi()) return;
  const test::TemporaryFolder folder;
  const std::string render = test::program() + " render " + test::box() + " -r 64 48 -s 64 -t 1 --stats s.json -f ";
  REQUIRE(test::run_shell(folder.path(), render + "one.pfm").exit_code == 0);
  for (const uint32_t ranks : {2u, 3u}) {
    const test::ProcessResult ran = test::run_shell(folder.path(), mpirun(ranks) + render + "many.pfm");
    CAPTURE(ran.err);
    CHECK(ran.exit_code == 0);
    CHECK(test::read_text(folder.file("many.pfm")) == test::read_text(folder.file("one.pfm")));
    const auto stats = nlohmann::json::parse(test::read_text(folder.file("s.json")));
    CHECK(stats["ranks"].size() == ranks);
    CHECK(ran.out.find(ranks == 2 ? "of 2 ranks," : "of 3 ranks,") != std::string::npos);
  }
}

TEST_CASE("mpirun: ranks that were started with other commands are not taken for one render") {
  if (no_mpi()) return;
  const test::TemporaryFolder folder;
  const std::string part = test::program() + " render -q " + test::box() + " -r 64 48 --samples ";
  const test::ProcessResult ran =
      test::run_shell(folder.path(), mpirun(1) + part + "0:4 -f a.exr : -n 1 " + part + "4:8 -f b.exr");
  CAPTURE(ran.err);
  CHECK(ran.exit_code != 0);
  CHECK(ran.err.find("rank 1: would draw another picture: command is ") != std::string::npos);
}

TEST_CASE("mpirun: a rank that is killed costs a restart, with other ranks or none, and no bits") {
  if (no_mpi()) return;
  const test::TemporaryFolder folder;
#ifdef NDEBUG
  const std::string kLong = "3000";
#else
  const std::string kLong = "150";  // under sanitizers
#endif
  const std::string render = test::program() + " render " + test::box() + " -r 64 48 -s " + kLong + " -t 1 -q -f ";
  // Each rank says which process it is, and becomes the program.
  const std::string named = "sh -c 'echo $$ >rank$OMPI_COMM_WORLD_RANK; exec \"$@\"' sh ";
  const test::ProcessResult lost = test::run_shell(
      folder.path(), mpirun(3) + named + render +
                         "lost.pfm --checkpoint c.exr --every 50ms & while ! [ -e c.exr ]; do sleep 0.02; done; "
                         "kill -9 $(cat rank2); wait $!");
  CAPTURE(lost.err);
  CHECK(lost.exit_code != 0);
  CHECK_FALSE(std::filesystem::exists(folder.file("lost.pfm")));
  std::filesystem::copy_file(folder.file("c.exr"), folder.file("d.exr"));
  CHECK(test::run_shell(folder.path(), render + "whole.pfm").exit_code == 0);
  CHECK(test::run_shell(folder.path(), render + "alone.pfm --checkpoint c.exr --resume").exit_code == 0);
  CHECK(test::run_shell(folder.path(), mpirun(2) + render + "two.pfm --checkpoint d.exr --resume").exit_code == 0);
  CHECK(test::read_text(folder.file("alone.pfm")) == test::read_text(folder.file("whole.pfm")));
  CHECK(test::read_text(folder.file("two.pfm")) == test::read_text(folder.file("whole.pfm")));
}

TEST_CASE("mpirun: what is wrong is said once, and nothing hangs") {
  if (no_mpi()) return;
  const test::TemporaryFolder folder;
  for (const auto& [arguments, error] :
       std::vector<std::pair<std::string, std::string>>{{"none.dae", "none.dae"},
                                                        {test::box() + " --no-such-flag", "--no-such-flag"},
                                                        {test::box() + " -f no/folder/x.png", "no/folder"},
                                                        {test::box() + " --reference float", "--reference"}}) {
    const test::ProcessResult ran =
        test::run_shell(folder.path(), mpirun(3) + test::program() + " render -q " + arguments);
    CAPTURE(ran.err);
    CHECK(ran.exit_code != 0);
    const size_t first = ran.err.find("lanewise: ");
    REQUIRE(first != std::string::npos);
    CHECK(ran.err.find(error, first) != std::string::npos);
    // Before there is any talk of ranks, each says it.
    if (error != "--no-such-flag") CHECK(ran.err.find("lanewise: ", first + 1) == std::string::npos);
  }
}

}  // namespace lanewise
