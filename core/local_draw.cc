#include "core/local_draw.h"

#include <algorithm>

#include "core/path_reuse.h"

namespace lanewise {
namespace {

// Wave by wave.
void run_batches(Wave& wave, Batch batch, size_t pixels, PixelSums* sums) {
  const uint64_t epoch_left = (uint64_t{1} << 32) - batch.first_sample % (uint64_t{1} << 32);
  if (batch.samples > epoch_left) {
    Batch head = batch;
    head.samples = static_cast<uint32_t>(epoch_left);
    run_batches(wave, head, pixels, sums);
    batch.first_sample += epoch_left;
    batch.samples -= head.samples;
    return run_batches(wave, batch, pixels, sums);
  }
  const uint64_t total = uint64_t{batch.samples} * pixels;
  for (; batch.first_path < total; batch.first_path += batch.paths) {
    batch.paths = static_cast<uint32_t>(std::min<uint64_t>(wave.size(), total - batch.first_path));
    wave.run(batch, sums);
  }
}

}  // namespace

Wave& LocalDraw::wave(uint32_t worker) {
  std::unique_ptr<Wave>& wave = waves_[worker];
  // By its own thread, so that its memory is near.
  if (!wave) wave = std::make_unique<Wave>(plan_, plan_.settings.wave, detail_);
  return *wave;
}

Drawn LocalDraw::draw(const std::vector<uint32_t>& pixels, uint64_t first, uint32_t count, PixelSums* sums,
                      uint32_t worker, const uint32_t* slots) {
  Wave& wave = this->wave(worker);
  const Profile& profile = wave.profiler().profile;
  const Drawn before{profile.rays(), profile.invalid_samples};
  Batch batch{.pixels = pixels.data(), .slots = slots, .samples = count, .first_sample = first};
  if (reuses_paths(plan_)) {
    const PixelSquares squares = squares_of(pixels, slots, plan_.settings.width, plan_.settings.height);
    batch.pixels = squares.pixels.data();
    batch.slots = squares.slots.data();
    batch.group = kPathsTogether;
    run_batches(wave, batch, squares.pixels.size(), sums);
  } else {
    run_batches(wave, batch, pixels.size(), sums);
  }
  return {profile.rays() - before.rays, profile.invalid_samples - before.invalid_samples};
}

Drawn LocalDraw::draw_light(const LightPiece& piece, uint32_t worker, const std::function<void(Splats&)>& take) {
  Wave& wave = this->wave(worker);
  const Profile& profile = wave.profiler().profile;
  const Drawn before{profile.rays(), profile.invalid_samples};
  Splats& splats = splats_[worker];
  splats.reserve(kSplatRoom);
  for (uint32_t done = 0; done < piece.count; done += wave.size()) {
    LightPiece part = piece;
    part.first += done;
    part.count = std::min(wave.size(), piece.count - done);
    wave.run_light_paths(part, splats);
    if (splats.size() >= kMostSplats) take(splats), splats.clear();
  }
  take(splats), splats.clear();
  return {profile.rays() - before.rays, profile.invalid_samples - before.invalid_samples};
}

std::vector<Profile> LocalDraw::profiles() const {
  std::vector<Profile> profiles;
  for (const std::unique_ptr<Wave>& wave : waves_) {
    if (wave) profiles.push_back(wave->profiler().profile);
  }
  return profiles;
}

std::vector<std::vector<LoggedCall>> LocalDraw::logs() const {
  std::vector<std::vector<LoggedCall>> logs;
  for (const std::unique_ptr<Wave>& wave : waves_) {
    if (wave) logs.push_back(wave->profiler().log());
  }
  return logs;
}

}  // namespace lanewise
