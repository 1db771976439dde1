// The radiance map around a scene, as kernels look it up and sample it. A direction's place in the picture, with z up (or
// y, of scenes that have it so: then z for -y and y for z below) and row 0 at the top: u = 1/2 - atan2(y, x) / (2 pi) from the left, v = acos(z) / pi from the top. Radiance is bilinear between
// the texels' centres, wraps around in u, and keeps the outer rows' up to the poles.
//
// A cell lies between four centres: cell (row, column) of rows 0 .. height and columns 0 .. width - 1 has the centres of rows
// row - 1 and row, columns column and column + 1; the first and the last row are half as high and end in the poles. Directions
// are sampled by cells, the row first, with a chance as the cell's mean luminance at its corners times its solid angle, and
// uniformly by solid angle within: the density is the same all over a cell, and 0 only where the map is black (Pharr, Jakob &
// Humphreys, Physically Based Rendering, 4th ed., sec. 12.5).
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/types.h"

namespace lanewise {

struct Image;

struct EnvironmentMap {
  // The centre at the upper left of a cell.
  struct alignas(16) Texel {
    float radiance[3];
    float pdf;  // of the cell, per steradian
  };
  // A row of cells. Heights are measured from the pole that is nearer, as 1 - |z|, which keeps its digits there.
  struct alignas(16) Row {
    float cdf;     // chance of the rows up to and with this one
    float height;  // of its upper edge
    float below;   // its lower edge's, less that
    float side;    // 1: of the upper pole, -1
  };

  uint32_t width = 0;   // of the picture, in texels; 0: no map
  uint32_t height = 0;  // of the picture
  bool y_up = false;    // of the world: its (x, y, z) are (x, -z, y) of the map
  float reach = 0;      // a segment of this length, a power of two, from anywhere on the scene ends outside of it
  AlignedVector<Texel> texels;      // (height + 2) x (width + 1): the outer rows and the first column stand twice
  AlignedVector<Row> rows;          // height + 1
  AlignedVector<float> column_cdf;  // (height + 1) x width: chance of the cells up to and with this one, within the row

  bool empty() const { return width == 0; }
  size_t bytes() const {
    return texels.size() * sizeof(Texel) + rows.size() * sizeof(Row) + column_cdf.size() * sizeof(float);
  }
};

// The most texels of a side and in all that a map may have: floats tell all cells apart, and 32-bit indices reach them.
constexpr uint32_t kMaxEnvironmentSide = 1 << 16;
constexpr uint64_t kMaxEnvironmentTexels = uint64_t{1} << 27;

// From a picture of finite radiance >= 0, within the sizes above, around a scene of this diagonal, which has y up
// or z. Empty for a picture that is black, or of no size.
EnvironmentMap make_environment_map(const Image& picture, double diagonal, bool y_up = false);

}  // namespace lanewise
