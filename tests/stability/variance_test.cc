// Failure mode: sum(x^2) - sum(x)^2 / n cancels for pixels that are bright and calm.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/film.h"
#include "core/path_buffer.h"
#include "tests/kernel_harness.h"
#include "tests/stability/curve.h"

namespace lanewise {
namespace {

constexpr uint32_t kSamples = 4096;

double exact_variance(const std::vector<float>& x) {
  long double mean = 0, squares = 0;
  for (const float v : x) mean += v;
  mean /= kSamples;
  for (const float v : x) squares += (v - mean) * (v - mean);
  return static_cast<double>(squares / (kSamples - 1));
}

template <class T>
double textbook_variance(const std::vector<float>& x) {
  T sum = 0, squares = 0;
  for (const float v : x) sum += T(v), squares += T(v) * T(v);
  return static_cast<double>((squares - sum * sum / T(kSamples)) / T(kSamples - 1));
}

// Through the kernel, as a grey pixel.
double film_variance(const std::vector<float>& x) {
  PathBuffer buffer(kSamples);
  PathState& s = buffer.state();
  const uint32_t pixel = 0;
  s.batch = {.pixels = &pixel, .samples = kSamples, .paths = kSamples};
  for (float* result : {s.result_r, s.result_g, s.result_b}) std::copy(x.begin(), x.end(), result);
  PixelSums sums;
  CHECK(accumulate(s, &sums) == 0);
  return luminance_variance(sums, kSamples);
}

}  // namespace

TEST_SUITE_BEGIN("stability");

TEST_CASE("stability: the variance of bright calm pixels does not cancel") {
  test::Curve curve{.name = "variance",
                    .title = "The variance of bright calm pixels cancels in a sum of squares",
                    .naive = "sum of squares, float",
                    .ours = "exact sums",
                    .x_axis = "mean / standard deviation of the samples",
                    .y_axis = "error of the variance (relative)"};
  double worst_double = 0;
  for (const double ratio : {1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6}) {
    std::mt19937 rng(5);
    std::normal_distribution<double> normal(ratio, 1);
    std::vector<float> x(kSamples);
    for (float& v : x) v = std::max(0.0f, static_cast<float>(normal(rng)));
    const double want = exact_variance(x);
    const auto error = [&](double got) { return std::abs(got / want - 1); };
    double ours = 0;
    test::for_each_target([&](const char*) { ours = std::max(ours, error(film_variance(x))); });
    curve.points.push_back({ratio, error(textbook_variance<float>(x)), ours});
    worst_double = std::max(worst_double, error(textbook_variance<double>(x)));
  }
  CHECK(curve.worst_naive() > 1);  // all digits lost, and the sign with them
  CHECK(worst_double > 1e-6);      // double puts it off
  CHECK(curve.worst_ours() < 1e-9);
  test::record(curve);
}

TEST_SUITE_END();

}  // namespace lanewise
