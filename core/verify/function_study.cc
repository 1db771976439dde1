#include "core/verify/function_study.h"

#include <chrono>
#include <cmath>
#include <limits>

#include "core/types.h"
#include "core/verify/exact_functions.h"
#include "core/verify/float_range.h"
#include "core/verify/ulp.h"
#include "core/workers.h"
#include "core/isa.h"

namespace lanewise::verify {
namespace {

struct Sums {
  double max = 0, sum = 0;
  float worst = 0;

  void add(float input, double error) {
    if (!(error <= max)) {
      max = std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
      worst = input;
    }
    sum += error;
  }
  void add(const Sums& other) {
    if (other.max > max) max = other.max, worst = other.worst;
    sum += other.sum;
  }
};

// A block of inputs: their exact values once, then one target after the other, each step on all threads. (Targets are chosen
// for the whole process.)
class Study {
 public:
  Study(const std::vector<std::string>& targets, uint32_t threads) : targets_(targets), threads_(threads) {}

  void add(const FunctionInfo& f, const FloatRange& inputs, uint64_t begin, uint64_t end, std::vector<Sums>& sums) {
    const size_t chunks = (end - begin + kChunk - 1) / kChunk;
    const auto each_chunk = [&](auto&& work) {
      const auto body = [&](size_t chunk, uint32_t) -> uint64_t {
        const size_t first = chunk * kChunk;
        work(chunk, first, std::min<size_t>(first + kChunk, end - begin));
        return 0;
      };
      run_workers(threads_, chunks, body, nullptr);
    };
    x_.assign(chunks * kChunk, f.hi);
    y_.resize(chunks * kChunk);
    exact_.resize(chunks * kChunk);
    const ExactFunction exact = exact_function(f.function);
    each_chunk([&](size_t, size_t first, size_t last) {
      for (size_t i = first; i < last; ++i) {
        x_[i] = inputs[begin + i];
        exact_[i] = exact(double{x_[i]});
      }
    });
    for (size_t target = 0; target < targets_.size(); ++target) {
      choose_isa(targets_[target]);
      std::vector<Sums> parts(chunks);
      each_chunk([&](size_t chunk, size_t first, size_t last) {
        apply_function(f.function, &x_[first], &y_[first], kChunk);
        for (size_t i = first; i < last; ++i) {
          parts[chunk].add(x_[i], std::abs(y_[i] - exact_[i]) * floats_per_unit(exact_[i]));
        }
      });
      for (const Sums& part : parts) sums[target].add(part);
    }
  }

 private:
  static constexpr size_t kChunk = 1 << 15;

  std::vector<std::string> targets_;
  uint32_t threads_;
  AlignedVector<float> x_, y_;
  std::vector<double> exact_;
};

}  // namespace

std::vector<FunctionError> study_functions(const std::vector<std::string>& targets, uint64_t stride, uint32_t threads,
                                           const std::function<void(const Progress&)>& progress) {
  constexpr uint64_t kBlock = uint64_t{1} << 22;
  const std::string before = chosen_isa();
  const auto start = std::chrono::steady_clock::now();
  uint64_t total = 0, done = 0;
  for (const FunctionInfo& f : kFunctions) {
    for (const FloatRange& inputs : float_ranges(f.lo, f.hi, f.hard, stride)) total += inputs.size();
  }
  Study study(targets, threads);
  std::vector<FunctionError> result;
  for (const FunctionInfo& f : kFunctions) {
    std::vector<Sums> sums(targets.size());
    uint64_t n = 0;
    for (const FloatRange& inputs : float_ranges(f.lo, f.hi, f.hard, stride)) {
      for (uint64_t begin = 0; begin < inputs.size(); begin += kBlock) {
        const uint64_t end = std::min(begin + kBlock, inputs.size());
        study.add(f, inputs, begin, end, sums);
        n += end - begin;
        done += end - begin;
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
        if (progress) progress({static_cast<double>(done) / static_cast<double>(total), 0, elapsed.count()});
      }
    }
    for (size_t t = 0; t < targets.size(); ++t) {
      result.push_back({&f, targets[t], n, sums[t].max, sums[t].sum / static_cast<double>(n), sums[t].worst});
    }
  }
  choose_isa(before);
  return result;
}

}  // namespace lanewise::verify
