// Independent renders of one scene, and tests of whether two renderers have the same expected picture.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/image.h"
#include "core/plan.h"
#include "tests/statistics/significance.h"

namespace lanewise::test {

using Renderer = std::function<Image(const Plan&)>;

Image simd(const Plan& plan);       // render, by the instruction set chosen at the moment
Image reference(const Plan& plan);  // render_reference<double>

// One picture for each seed first_seed, first_seed + 1 ... first_seed + count - 1.
std::vector<Image> independent_renders(Plan& plan, const Renderer& renderer, uint64_t first_seed, uint32_t count);

// Mean luminance of each block of side x side pixels (cut off at the borders), row by row, over the pictures.
std::vector<Moments> block_moments(const std::vector<Image>& pictures, uint32_t side);

// Pictures a and b of different seeds: Welch's test of each pixel, of each block, and of the picture's mean. Pixels of few
// samples are far from normal, as blocks of many are not; but as many pictures on both sides make the difference
// symmetric, and then heavy tails only make Welch's test milder (Jung, Hanika & Dachsbacher, JCGT 2020).
struct Unpaired {
  double pixels_passed;         // share of pixels with p above Sidak's level for 0.01 (Mitsuba 3 asks for 0.9975)
  std::vector<double> block_p;  // of blocks that vary
  double mean_p;                // of the pictures' mean luminance
  double difference;            // of the means, over b's
  double error;                 // standard error of the difference
};
Unpaired compare_unpaired(const std::vector<Image>& a, const std::vector<Image>& b, uint32_t block_side);

// Pictures a and b of the same seeds, pair by pair: all but a few pixels are of the same paths, so what differs is rounding
// and the paths that it sends elsewhere.
struct Paired {
  double differing;   // share of pixels that are more than 1% apart
  double difference;  // mean of a - b over b's mean
  double error;       // standard error of the difference, over pixels
};
Paired compare_paired(const std::vector<Image>& a, const std::vector<Image>& b);

// How many p-values lie in each tenth of [0, 1].
std::vector<double> histogram_of_ten(const std::vector<double>& p_values);

// Whether p-values are uniform: chi-square of that histogram.
double uniform_p(const std::vector<double>& p_values);

}  // namespace lanewise::test
