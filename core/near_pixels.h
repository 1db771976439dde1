// The pixels around one of a MeanPicture, and which of them are independent of it: those of other squares.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "core/film.h"

namespace lanewise {

// f(pixel, together) for (x, y) and the up to eight pixels around it, and whether they are in its square.
template <class F>
void for_each_near(const MeanPicture& picture, uint32_t x, uint32_t y, const F& f) {
  // Where its square begins, in the whole picture.
  const uint32_t column = picture.square_column(x) * picture.side, row = picture.square_row(y) * picture.side;
  for (uint32_t j = y - std::min(y, 1u); j < std::min(y + 2, picture.height); ++j) {
    const bool same_row = j + picture.row - row < picture.side;
    for (uint32_t i = x - std::min(x, 1u); i < std::min(x + 2, picture.width); ++i) {
      const bool together = same_row && i + picture.column - column < picture.side;
      f(picture.pixels[size_t{j} * picture.width + i], together);
    }
  }
}

// f(pixel) for those that are independent of it.
template <class F>
void for_each_neighbour(const MeanPicture& picture, uint32_t x, uint32_t y, const F& f) {
  for_each_near(picture, x, y, [&](const PixelMean& pixel, bool together) {
    if (!together) f(pixel);
  });
}

}  // namespace lanewise
