// A tile of the picture: the unit of work of a thread, which alone adds to its pixels.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/sample_shares.h"
#include "core/settings.h"

namespace lanewise {

// No more samples of a pixel are drawn at a time than this: so a tile is done in a second or so, and the render can stop.
constexpr uint32_t kLongestRound = 4096;

struct Tile {
  std::vector<uint32_t> pixels;  // y * width + x
};

// f(x, y) for the pixels of a window, group by group.
template <class F>
void for_each_by_groups(const Window& window, const F& f) {
  constexpr uint32_t kBlock = SampleShares::kBlock;
  const uint32_t x_end = window.x + window.width, y_end = window.y + window.height;
  const auto is_inside = [&](uint32_t x, uint32_t y) {
    return x >= window.x && x < x_end && y >= window.y && y < y_end;
  };
  for (uint32_t row = window.y / kBlock * kBlock; row < y_end; row += kBlock) {
    for (uint32_t column = window.x / kBlock * kBlock; column < x_end; column += kBlock) {
      for (uint32_t colour = 0; colour < SampleShares::kColours; ++colour) {
        for (uint32_t k = 0; k < kBlock * kBlock; ++k) {
          const uint32_t x = column + k % kBlock, y = row + k / kBlock;
          if (is_inside(x, y) && SampleShares::colour(x, y) == colour) f(x, y);
        }
      }
    }
  }
}

// Cuts the window into squares of a side that gives a tile's samples, so many a pixel, a full wave, if the picture is large
// enough for that to leave every thread work to the end. Cuts are at multiples of the side: through no square of
// core/path_reuse.h. by_groups: pixels of one group of core/sample_shares.h come together, not row by row.
inline std::vector<Tile> make_tiles(const Settings& settings, uint32_t samples, bool by_groups = false) {
  constexpr uint32_t kMinSide = 16, kMaxSide = 64;
  uint32_t side = kMinSide;
  while (side < kMaxSide && uint64_t{side} * side * samples < settings.wave) side *= 2;
  const Window window = settings.window();
  const uint32_t x_end = window.x + window.width, y_end = window.y + window.height;
  std::vector<Tile> tiles;
  const auto next = [side](uint32_t at, uint32_t end) { return std::min((at / side + 1) * side, end); };
  for (uint32_t y0 = window.y; y0 < y_end; y0 = next(y0, y_end)) {
    for (uint32_t x0 = window.x; x0 < x_end; x0 = next(x0, x_end)) {
      const uint32_t columns = next(x0, x_end) - x0, rows = next(y0, y_end) - y0;
      Tile& tile = tiles.emplace_back();
      tile.pixels.reserve(size_t{columns} * rows);
      const auto add = [&](uint32_t x, uint32_t y) { tile.pixels.push_back(y * settings.width + x); };
      if (by_groups) {
        for_each_by_groups({x0, y0, columns, rows}, add);
        continue;
      }
      for (uint32_t y = y0; y < y0 + rows; ++y) {
        for (uint32_t x = x0; x < x0 + columns; ++x) add(x, y);
      }
    }
  }
  return tiles;
}

}  // namespace lanewise
