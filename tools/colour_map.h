// Numbers as colours: matplotlib's maps (van der Walt and Smith, 2015), even to the eye, and in grey too.
#pragma once

#include <array>

namespace lanewise {

// x in [0, 1] to linear RGB, as pictures hold colours. viridis: dark blue, green, yellow; magma: black, purple, orange,
// pale yellow. Within 7/255 of matplotlib's sRGB.
std::array<float, 3> viridis(double x);
std::array<float, 3> magma(double x);

}  // namespace lanewise
