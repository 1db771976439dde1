#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/film.h"

namespace lanewise::test {

// A picture whose pixels all have that mean, of that variance.
inline MeanPicture flat_means(uint32_t width, uint32_t height, float value, float variance) {
  return {width, height, std::vector<PixelMean>(size_t{width} * height, {{value, value, value}, variance})};
}

}  // namespace lanewise::test
