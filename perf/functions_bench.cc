// Speed against accuracy of the functions that kernels are made of, every variant on every target, as JSON:
//   build/functions_bench [--rounds 300] [--stride 257]
// Errors are in ulp, spacings of floats at the exact value, over every stride-th float of the domain and all floats
// around what is hard in it. Where the exact value is 0, which has no ulp to speak of, only whether the result is 0
// counts. Cycles are those of the core: the time stamp counter's ticks, turned into cycles by a chain of
// multiplications that take three each. Every round runs all variants in turn, on arrays that fit the first-level
// cache; the least of all rounds counts, so that neighbours on the machine do not.
#include <x86intrin.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "core/render.h"
#include "core/types.h"
#include "core/verify/float_range.h"
#include "core/verify/ulp.h"
#include "core/isa.h"
#include "perf/studied_functions.h"

namespace lanewise {
namespace {

constexpr size_t kElements = 2048;

struct Errors {
  uint64_t inputs = 0;
  double max = 0, sum = 0;
  float worst = 0;
  bool zeros = true;  // results are 0 where the exact values are

  void add(float input, float result, double exact) {
    if (exact == 0) {
      zeros &= result == 0;
      return;
    }
    const double error = std::abs(result - exact) * verify::floats_per_unit(exact);
    ++inputs;
    sum += error;
    if (error <= max) return;
    max = std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
    worst = input;
  }
};

// A variant on one target or in one of the twins' types.
struct Contender {
  const StudiedFunction* function;
  std::string variant, target;
  ArrayFunction apply;
  std::string isa;  // that apply needs chosen; empty: any
  Errors errors{};
  double ticks = std::numeric_limits<double>::infinity();  // for kElements

  void run(const float* x, float* y, size_t n) const {
    if (!isa.empty()) choose_isa(isa);
    apply(x, y, n);
  }
};

std::vector<Contender> contenders_of(const StudiedFunction& f) {
  std::vector<Contender> all;
  for (const FunctionVariant& v : f.variants) {
    if (v.vectors) {
      for (const std::string& isa : supported_isas()) all.push_back({&f, v.name, isa, v.vectors, isa});
    }
    if (v.in_float) all.push_back({&f, v.name, "float", v.in_float, ""});
    if (v.in_double) all.push_back({&f, v.name, "double", v.in_double, ""});
  }
  return all;
}

void measure_errors(std::vector<Contender>& contenders, const StudiedFunction& f, uint64_t stride) {
  constexpr size_t kBlock = 1 << 16;
  AlignedVector<float> x(kBlock), y(kBlock);
  std::vector<double> exact(kBlock);
  const FunctionDomain& d = f.domain;
  for (const verify::FloatRange& range : verify::float_ranges(d.lo, d.hi, d.hard, stride)) {
    for (uint64_t begin = 0; begin < range.size(); begin += kBlock) {
      const size_t n = std::min<uint64_t>(kBlock, range.size() - begin);
      std::fill(x.begin(), x.end(), d.hi);
      for (size_t i = 0; i < n; ++i) {
        x[i] = range[begin + i];
        exact[i] = f.exact(double{x[i]});
      }
      for (Contender& c : contenders) {
        if (c.function != &f) continue;
        c.run(x.data(), y.data(), kBlock);
        for (size_t i = 0; i < n; ++i) c.errors.add(x[i], y[i], exact[i]);
      }
    }
  }
}

// Of the time stamp counter, which ticks alike at any frequency of the core; what stands before is done by then.
uint64_t ticks() {
  _mm_lfence();
  const uint64_t now = __rdtsc();
  _mm_lfence();
  return now;
}

template <class Run>
double least_ticks(const Run& run) {
  double least = std::numeric_limits<double>::infinity();
  for (int repeat = 0; repeat < 4; ++repeat) {
    const uint64_t start = ticks();
    run();
    least = std::min(least, static_cast<double>(ticks() - start));
  }
  return least;
}

// 64-bit multiplications, each waiting for the last: 3 cycles on Intel's processors since Nehalem and on AMD's Zen.
constexpr double kChainCycles = 3 * 4096;
void run_chain() {
  uint64_t v = 3;
  for (int i = 0; i < 4096 / 8; ++i) {
    asm volatile(
        "imul %0, %0\n imul %0, %0\n imul %0, %0\n imul %0, %0\n imul %0, %0\n imul %0, %0\n imul %0, %0\n imul %0, %0"
        : "+r"(v));
  }
}

// Fills in ticks; returns ticks per cycle of the core.
double measure_speed(std::vector<Contender>& contenders, uint32_t rounds) {
  AlignedVector<float> y(kElements);
  std::vector<AlignedVector<float>> inputs;
  for (const Contender& c : contenders) {
    std::mt19937 rng(1);
    std::uniform_real_distribution<float> uniform(c.function->domain.timed_lo, c.function->domain.timed_hi);
    inputs.emplace_back(kElements);
    std::generate(inputs.back().begin(), inputs.back().end(), [&] { return uniform(rng); });
  }
  double chain = std::numeric_limits<double>::infinity();
  for (uint32_t round = 0; round < rounds; ++round) {
    for (size_t i = 0; i < contenders.size(); ++i) {
      Contender& c = contenders[i];
      if (!c.isa.empty()) choose_isa(c.isa);
      const double took = least_ticks([&] { c.apply(inputs[i].data(), y.data(), kElements); });
      c.ticks = std::min(c.ticks, took);
      chain = std::min(chain, least_ticks(run_chain));
    }
  }
  return chain / kChainCycles;
}

int run(uint64_t stride, uint32_t rounds) {
  const std::vector<StudiedFunction> functions = studied_functions();
  std::vector<Contender> contenders;
  for (const StudiedFunction& f : functions) {
    for (Contender& c : contenders_of(f)) contenders.push_back(std::move(c));
  }
  for (const StudiedFunction& f : functions) measure_errors(contenders, f, stride);
  const double ticks_per_cycle = measure_speed(contenders, rounds);
  nlohmann::ordered_json json = {{"stride", stride},
                                 {"rounds", rounds},
                                 {"elements", kElements},
                                 {"ticks_per_cycle", ticks_per_cycle},
                                 {"functions", nlohmann::json::array()}};
  for (const StudiedFunction& f : functions) {
    nlohmann::ordered_json entry = {
        {"name", f.name}, {"inputs", f.domain.inputs}, {"lo", f.domain.lo}, {"hi", f.domain.hi}};
    for (const Contender& c : contenders) {
      if (c.function != &f) continue;
      entry["results"].push_back({{"variant", c.variant},
                                  {"target", c.target},
                                  {"cycles", c.ticks / ticks_per_cycle / kElements},
                                  {"max_ulp", c.errors.max},
                                  {"mean_ulp", c.errors.sum / static_cast<double>(c.errors.inputs)},
                                  {"worst_input", c.errors.worst},
                                  {"inputs", c.errors.inputs},
                                  {"zeros", c.errors.zeros}});
    }
    json["functions"].push_back(entry);
  }
  std::cout << json.dump(1) << "\n";
  return 0;
}

}  // namespace
}  // namespace lanewise

int main(int argc, char** argv) {
  CLI::App app("Speed against accuracy of the functions that kernels are made of, as JSON");
  uint64_t stride = 257;
  uint32_t rounds = 300;
  app.add_option("--stride", stride, "Errors on every N-th float of the domains")->check(CLI::PositiveNumber);
  app.add_option("--rounds", rounds, "Rounds of timing")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  return lanewise::run(stride, rounds);
}
