#include "core/render.h"

#include <algorithm>
#include <chrono>
#include <memory>

#include "core/schedule.h"
#include "core/stats.h"
#include "core/wave.h"

namespace lanewise {
namespace {

// Adds samples first .. first + count - 1 of all the pixels to their sums, wave by wave.
void run_batches(Wave& wave, const std::vector<uint32_t>& pixels, uint64_t first, uint32_t count, PixelSums* sums) {
  const uint64_t epoch_left = (uint64_t{1} << 32) - first % (uint64_t{1} << 32);
  if (count > epoch_left) {
    const auto head = static_cast<uint32_t>(epoch_left);
    run_batches(wave, pixels, first, head, sums);
    return run_batches(wave, pixels, first + head, count - head, sums);
  }
  Batch batch{.pixels = pixels.data(), .samples = count, .first_sample = first};
  const uint64_t total = uint64_t{count} * pixels.size();
  for (; batch.first_path < total; batch.first_path += batch.paths) {
    batch.paths = static_cast<uint32_t>(std::min<uint64_t>(wave.size(), total - batch.first_path));
    wave.run(batch, sums);
  }
}

}  // namespace

RenderResult render(const Plan& plan, const RenderControl& control, ProfileDetail detail) {
  const auto start = std::chrono::steady_clock::now();
  const uint32_t threads = thread_count(plan.settings);
  std::vector<std::unique_ptr<Wave>> waves(threads);
  const auto draw = [&](const std::vector<uint32_t>& pixels, uint64_t first, uint32_t count, PixelSums* sums,
                        uint32_t worker) {
    std::unique_ptr<Wave>& wave = waves[worker];
    if (!wave)
      wave = std::make_unique<Wave>(plan, plan.settings.wave, detail);  // by its own thread, so that its memory is near
    const uint64_t before = wave->profiler().profile.rays();
    run_batches(*wave, pixels, first, count, sums);
    return wave->profiler().profile.rays() - before;
  };
  const RenderControl counting = count_invalid(control, [&] {
    uint64_t invalid = 0;
    for (const std::unique_ptr<Wave>& wave : waves) invalid += wave ? wave->profiler().profile.invalid_samples : 0;
    return invalid;
  });
  Exposure exposure = expose(plan.settings, threads, draw, counting);

  const auto elapsed = std::chrono::steady_clock::now() - start;
  std::vector<Profile> profiles;
  std::vector<std::vector<LoggedCall>> logs;
  for (const std::unique_ptr<Wave>& wave : waves) {
    if (!wave) continue;
    profiles.push_back(wave->profiler().profile);
    logs.push_back(wave->profiler().log());
  }
  RenderResult result = make_result(std::move(exposure), profiles, control.resume, elapsed);
  result.logs = std::move(logs);
  return result;
}

}  // namespace lanewise
