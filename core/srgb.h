// The sRGB transfer function (IEC 61966-2-1), both ways on [0, 1].
#pragma once

#include <cmath>

namespace lanewise {

inline double srgb_from_linear(double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055; }
inline double linear_from_srgb(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

}  // namespace lanewise
