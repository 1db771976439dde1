// A tile of the picture: the unit of work of a thread, which alone adds to its pixels.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/settings.h"

namespace lanewise {

// No more samples of a pixel are drawn at a time than this: so a tile is done in a second or so, and the render can stop.
constexpr uint32_t kLongestRound = 4096;

struct Tile {
  std::vector<uint32_t> pixels;  // y * width + x
};

// Cuts the window into squares of a side that gives a tile's samples, so many a pixel, a full wave, if the picture is large
// enough for that to leave every thread work to the end. Cuts are at multiples of the side: through no square of
// core/path_reuse.h.
inline std::vector<Tile> make_tiles(const Settings& settings, uint32_t samples) {
  constexpr uint32_t kMinSide = 16, kMaxSide = 64;
  uint32_t side = kMinSide;
  while (side < kMaxSide && uint64_t{side} * side * samples < settings.wave) side *= 2;
  const Window window = settings.window();
  const uint32_t x_end = window.x + window.width, y_end = window.y + window.height;
  std::vector<Tile> tiles;
  const auto next = [side](uint32_t at, uint32_t end) { return std::min((at / side + 1) * side, end); };
  for (uint32_t y0 = window.y; y0 < y_end; y0 = next(y0, y_end)) {
    for (uint32_t x0 = window.x; x0 < x_end; x0 = next(x0, x_end)) {
      Tile& tile = tiles.emplace_back();
      for (uint32_t y = y0; y < next(y0, y_end); ++y) {
        for (uint32_t x = x0; x < next(x0, x_end); ++x) tile.pixels.push_back(y * settings.width + x);
      }
    }
  }
  return tiles;
}

}  // namespace lanewise
