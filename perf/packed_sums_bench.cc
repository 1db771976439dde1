// How fast a pixel's sums are packed, and unpacked and added, a thread: of 256 samples as a scene's are.
//   build/packed_sums_bench
#include <benchmark/benchmark.h>

#include <random>
#include <string>
#include <vector>

#include "core/packed_sums.h"

namespace lanewise {
namespace {

std::vector<PixelSums> some_sums() {
  constexpr int kPixels = 4096, kSamples = 256;
  std::mt19937 rng(1);
  std::lognormal_distribution<float> radiance(-2, 1);
  std::vector<PixelSums> sums(kPixels);
  for (PixelSums& pixel : sums) {
    for (int i = 0; i < kSamples; ++i) pixel.add(radiance(rng), radiance(rng), radiance(rng));
  }
  return sums;
}

void Pack(benchmark::State& state) {
  const std::vector<PixelSums> sums = some_sums();
  for (auto _ : state) {
    std::string packed;
    packed.reserve(sums.size() * sizeof(PixelSums) / 2);
    for (const PixelSums& pixel : sums) pack(pixel, packed);
    benchmark::DoNotOptimize(packed);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(sums.size()));
}
BENCHMARK(Pack);

void Unpack(benchmark::State& state) {
  std::vector<PixelSums> sums = some_sums();
  std::string packed;
  for (const PixelSums& pixel : sums) pack(pixel, packed);
  for (auto _ : state) {
    ByteReader in(packed);
    for (PixelSums& pixel : sums) pixel += unpack_sums(in);
    benchmark::DoNotOptimize(sums.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(sums.size()));
}
BENCHMARK(Unpack);

}  // namespace
}  // namespace lanewise

BENCHMARK_MAIN();
