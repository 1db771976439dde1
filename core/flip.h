// FLIP: how large the difference looks to someone who flips between a picture and its reference in place. Andersson,
// Nilsson, Akenine-Moeller, Oskarsson, Astroem and Fairchild, FLIP: A Difference Evaluator for Alternating Images, HPG
// 2020; for high dynamic range Andersson, Nilsson, Shirley and Akenine-Moeller, Visualizing Errors in Rendered High
// Dynamic Range Images, Eurographics 2021 (short papers).
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"

namespace lanewise {

// The papers' viewer: 0.7 m from a display 0.7 m and 3840 pixels wide.
inline constexpr double kFlipPixelsPerDegree = 67.0206433;

// In stops: radiance is multiplied by 2 to the power of each.
struct FlipExposures {
  double start = 0, stop = 0;
  uint32_t count = 1;  // evenly spaced, both ends included
};

// Errors per pixel in [0, 1], rows from the top. For all functions: pictures are linear radiance, not empty, of one
// size (otherwise Error, naming both); values below 0 count as 0. A pixel with a NaN in either picture has error 1 and
// is black to its neighbours. The result does not depend on the number of threads. pixels_per_degree: 5 or more, of
// visual angle.

// Of what a display shows: radiance clipped to [0, 1].
std::vector<float> flip_ldr(const Image& test, const Image& reference, double pixels_per_degree = kFlipPixelsPerDegree);

// The largest over several exposures, each tone mapped by the ACES curve.
std::vector<float> flip_hdr(const Image& test, const Image& reference, const FlipExposures& exposures,
                            double pixels_per_degree = kFlipPixelsPerDegree);

// From that which brings the reference's brightest pixel to 0.85 of white to that which brings its median there, about
// a stop apart (section 3 of the HDR paper). Black pixels are left out of the median if it would be 0; a reference that
// is black everywhere is shown as it is.
FlipExposures flip_exposures(const Image& reference);

// Pooled errors. Weighted: the error that pixels of a quarter, half, three quarters of all the error lie at or below.
struct FlipSummary {
  double mean = 0, min = 0, max = 0;
  double weighted_quartile1 = 0, weighted_median = 0, weighted_quartile3 = 0;
};

FlipSummary summarize_flip(std::vector<float> errors);

}  // namespace lanewise
