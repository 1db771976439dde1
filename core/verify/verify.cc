#include "core/verify/verify.h"

#include <chrono>
#include <memory>

#include "core/path_buffer.h"
#include "core/verify/kernel_case.h"
#include "core/verify/plans.h"
#include "core/verify/squares.h"
#include "core/verify/whole_wave.h"
#include "core/workers.h"

namespace lanewise::verify {
namespace {

// A wave of paths on one plan, and what the twin makes of them.
class Wave {
 public:
  Wave(const Plan& plan, const KernelCase& kernel, const Step& step, uint32_t paths, uint32_t seed)
      : plan_(plan), kernel_(kernel), oracle_(plan, kernel), before_(paths), expected_(paths) {
    std::mt19937 rng(seed);
    for (uint32_t i = 0; i < paths; ++i) {
      before_[i].slot = i;
      before_[i].step = step;
      kernel.fill(plan, rng, before_[i]);
      expected_[i] = oracle_.expect(before_[i]);
    }
  }

  Tally run() const {
    const uint32_t n = static_cast<uint32_t>(before_.size());
    PathBuffer buffer(round_up_to_lanes(n));
    PathState& s = buffer.state();
    s.step = before_[0].step;
    for (uint32_t i = 0; i < n; ++i) store_path(s, i, before_[i]);
    kernel_.kernel(plan_, s, {0, n});
    Tally tally = oracle_.tally();
    for (uint32_t i = 0; i < n; ++i) oracle_.compare(before_[i], expected_[i], load_path<float>(s, i), tally);
    return tally;
  }

 private:
  const Plan& plan_;
  const KernelCase& kernel_;
  Oracle oracle_;
  std::vector<Path<float>> before_;
  std::vector<Expected> expected_;
};

// Every plan with all settings.
std::vector<Plan> all_plans() {
  std::vector<Plan> result;
  for (const Plan& plan : verification_plans()) {
    for (const Settings& settings : verification_settings()) {
      result.push_back(plan);
      result.back().settings = settings;
    }
  }
  return result;
}

Step step_of(const Plan& plan, uint32_t i) {
  return {.bounce = i % (plan.settings.max_depth + 2),
          .light = i % sampled_lights(plan),
          .light_sample = i / 2 % plan.settings.light_samples};
}

// A kernel that does more than compute a path's fields: how far off it is, in the bound's unit.
struct WholeCase {
  const char* name;
  FieldBound bound;
  double (*error)(uint32_t paths, uint32_t seed);
};
constexpr WholeCase kWholeCases[] = {{"sort", exact("paths"), sort_errors},
                                     {"keep_first", exact("kept"), keep_first_error},
                                     {"keep_second", kKeepSecondBound, keep_second_error},
                                     {"connect_paths", kConnectPathsBound, connect_paths_error},
                                     {"share_paths", kSharePathsBound, share_paths_error},
                                     {"retire", exact("result"), retire_errors},
                                     {"count_shadow_rays", exact("count"), count_shadow_rays_errors},
                                     {"accumulate", exact("film"), accumulate_errors}};

KernelResult run_whole(const WholeCase& c, const std::string& target, const VerifyOptions& options) {
  const double error = c.error(options.paths, options.seed);
  KernelResult result{c.name, target, {}};
  result.tally.paths = options.paths;
  result.tally.failed = error > c.bound.max;
  result.tally.fields.push_back({c.bound, error, error});
  if (error > c.bound.max) result.tally.first_failure = std::to_string(error) + (c.bound.max > 0 ? " off" : " wrong");
  return result;
}

}  // namespace

std::vector<KernelResult> verify_kernels(const VerifyOptions& options,
                                         const std::function<void(const Progress&)>& progress) {
  const std::string before = chosen_isa();
  const auto start = std::chrono::steady_clock::now();
  const std::vector<Plan> plans = all_plans();
  const uint32_t waves = static_cast<uint32_t>(plans.size()), paths = (options.paths + waves - 1) / waves;
  std::vector<KernelResult> results;
  for (const KernelCase& kernel : kernel_cases()) {
    std::vector<std::unique_ptr<Wave>> all(waves);
    const auto prepare = [&](size_t i, uint32_t) -> uint64_t {
      const uint32_t n = static_cast<uint32_t>(i);
      all[i] = std::make_unique<Wave>(plans[i], kernel, step_of(plans[i], n), paths, options.seed * waves + n);
      return 0;
    };
    run_workers(options.threads, waves, prepare, nullptr);
    for (const std::string& target : options.targets) {
      choose_isa(target);
      std::vector<Tally> tallies(waves);
      const auto run = [&](size_t i, uint32_t) -> uint64_t {
        tallies[i] = all[i]->run();
        return 0;
      };
      run_workers(options.threads, waves, run, nullptr);
      for (uint32_t i = 1; i < waves; ++i) tallies[0].add(tallies[i]);
      results.push_back({kernel.name, target, tallies[0]});
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    const size_t done = static_cast<size_t>(&kernel - kernel_cases().data()) + 1;
    if (progress)
      progress({static_cast<double>(done) / static_cast<double>(kernel_cases().size()), 0, elapsed.count()});
  }
  for (const WholeCase& c : kWholeCases) {
    for (const std::string& target : options.targets) {
      choose_isa(target);
      results.push_back(run_whole(c, target, options));
    }
  }
  choose_isa(before);
  return results;
}

}  // namespace lanewise::verify
