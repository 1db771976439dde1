// Pearson's test of what a sampler draws against the density that the renderer gives for it, as in Mitsuba 3's chi2.py.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/path_buffer.h"
#include "core/plan.h"
#include "kernels/kernels.h"
#include "tests/statistics/significance.h"

namespace lanewise::test {

#ifdef NDEBUG
constexpr uint32_t kDraws = 1 << 18;  // by each test of a sampler
constexpr uint32_t kLobeSide = 40;    // cells along each side of a lobe
#else
constexpr uint32_t kDraws = 1 << 14;
constexpr uint32_t kLobeSide = 20;
#endif

struct Interval {
  double lo, hi;  // empty where lo >= hi
};

// Two parameters that say what was drawn, over a rectangle cut into equal cells.
struct Domain {
  Interval x, y;
  uint32_t columns, rows;

  // Density of x and y, >= 0.
  std::function<double(double x, double y)> density;
  // The x of this y where the density is above 0, so that quadrature stops there; none: all of them.
  std::function<Interval(double y)> support = nullptr;
};

// The density's integral over each cell, row by row.
std::vector<double> integrate_cells(const Domain& domain);
double integrate(const Domain& domain);

class ChiSquare {
 public:
  explicit ChiSquare(const Domain& domain);

  void add(double x, double y);
  void add_void() { ++void_; }  // drawn, but not used: the sampler gives density 0

  // Of all draws, the void ones as one cell more. 0 if any lies outside of the rectangle or (of some thousands that are
  // looked at) where the density is 0, if a cell's density is negative, or its integral above 1 + kExcess.
  double p() const;

  static constexpr double kExcess = 1e-4;  // Mitsuba's is 0.1; quadrature here is good to 1e-5

 private:
  Domain domain_;
  std::vector<double> shares_, counts_;  // of each cell
  double integral_;
  uint32_t draws_ = 0, void_ = 0, impossible_ = 0;
};

// Runs the kernel on `draws` paths like this one, which differ in their sample index alone, and hands each to
// use(state, index).
template <class KernelCall, class Use>
void for_each_draw(const KernelCall& kernel, const Plan& plan, Path<float> path, uint32_t draws, const Use& use) {
  constexpr uint32_t kChunk = 1 << 12;
  PathBuffer buffer(kChunk);
  PathState& s = buffer.state();
  s.step = path.step;
  for (uint32_t done = 0; done < draws; done += kChunk) {
    const uint32_t n = std::min(kChunk, draws - done);
    for (uint32_t i = 0; i < n; ++i) {
      path.sample = done + i;
      path.slot = i;
      store_path(s, i, path);
    }
    kernel(plan, s, {0, n});
    for (uint32_t i = 0; i < n; ++i) use(s, i);
  }
}

}  // namespace lanewise::test
