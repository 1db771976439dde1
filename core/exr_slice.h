// Arrays as OpenEXR wants them told.
#pragma once

#include <ImfFrameBuffer.h>

#include <cstddef>
#include <cstdint>

namespace lanewise {

// A channel of a data window that begins at (x, y), in rows of `width` pixels, `stride` bytes from one to the next; first: of the
// window's first pixel.
inline Imf::Slice exr_slice(Imf::PixelType type, const void* first, size_t stride, int64_t x, int64_t y, size_t width) {
  const int64_t offset = static_cast<int64_t>(stride) * (x + y * static_cast<int64_t>(width));
  // As integers: the base of a window that does not begin at 0 lies outside the array, where no pointer may point.
  const auto base = reinterpret_cast<intptr_t>(first) - offset;
  return {type, reinterpret_cast<char*>(base), stride, stride * width};
}

}  // namespace lanewise
