// The error of a picture, from its own samples: MRSE as compare_images() would measure it against the true picture.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "core/film.h"

namespace lanewise {

class Probes;

// Mean of (x - truth)^2 / (truth + 0.01)^2 over pixels and channels. The true value lies in [low, high] with 95% probability,
// as far as can be said of distributions with tails as long as those of paths.
struct ErrorEstimate {
  double mrse = 0;
  double low = 0;
  double high = 0;
};

// From the expected square of every pixel's error by channel, or an estimate of it. Rows are shared out to threads.
using SquaredError = std::function<std::array<double, 3>(size_t pixel)>;
ErrorEstimate estimate_error(const MeanPicture& picture, const SquaredError& squares, uint32_t threads);

// From the variances in the picture alone, times the factor that the probes measure: samples that are not independent,
// as those of a low-discrepancy sequence, have less error than their variance says. light: what light paths add to it, with
// variances of its own, that no factor applies to; null if there are none.
ErrorEstimate estimate_error(const MeanPicture& picture, const MeanPicture* light, const Probes& probes,
                             uint32_t threads);

}  // namespace lanewise
