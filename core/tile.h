// A tile of the picture: the unit of work of a thread, which alone adds to its pixels.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/settings.h"

namespace lanewise {

struct Tile {
  std::vector<uint32_t> pixels;  // y * width + x
};

// Squares of a side that gives a tile's samples a full wave, if the picture is large enough for that to leave every
// thread work to the end.
inline std::vector<Tile> make_tiles(const Settings& settings) {
  constexpr uint32_t kMinSide = 16, kMaxSide = 64;
  uint32_t side = kMinSide;
  while (side < kMaxSide && uint64_t{side} * side * settings.spp < settings.wave) side *= 2;
  std::vector<Tile> tiles;
  for (uint32_t y0 = 0; y0 < settings.height; y0 += side) {
    for (uint32_t x0 = 0; x0 < settings.width; x0 += side) {
      Tile& tile = tiles.emplace_back();
      for (uint32_t y = y0; y < std::min(y0 + side, settings.height); ++y) {
        for (uint32_t x = x0; x < std::min(x0 + side, settings.width); ++x)
          tile.pixels.push_back(y * settings.width + x);
      }
    }
  }
  return tiles;
}

}  // namespace lanewise
