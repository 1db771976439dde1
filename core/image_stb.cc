#include "core/image_stb.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <new>

#include "core/srgb.h"
#include "core/stb_guard.h"
#include "core/types.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
// All zeros: stb would decode a JPEG that leaves out a Huffman table by whatever memory holds in its place.
#define STBI_MALLOC(size) std::calloc(1, size)
#define STBI_REALLOC(memory, size) std::realloc(memory, size)
#define STBI_FREE(memory) std::free(memory)
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#include <stb/stb_image.h>
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace lanewise {
namespace {

void append_to_string(void* context, void* data, int size) {
  static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<size_t>(size));
}

// stb quotes names of chunks, whatever they are.
Error damaged() {
  std::string reason = stbi_failure_reason();
  std::ranges::replace_if(
      reason, [](unsigned char c) { return c < ' ' || c >= 0x7F; }, '?');
  return Error("damaged picture (" + reason + ")");
}

std::vector<float> linear_of_short() {
  std::vector<float> linear(65536);
  for (size_t v = 0; v < linear.size(); ++v)
    linear[v] = static_cast<float>(linear_from_srgb(static_cast<double>(v) / 65535));
  return linear;
}

// What a file of so many bytes may hold: deflate makes at most 1032 bytes of one, and small pictures are nobody's harm.
uint64_t bearable_pixels(size_t bytes) { return (uint64_t{1} << 22) + uint64_t{1032} * bytes; }

// A picture in memory, its size known to be bearable.
struct Encoded {
  const stbi_uc* data;
  int size;
  int width = 0, height = 0;

  Encoded(const std::string& bytes, uint64_t max_pixels)
      : data(reinterpret_cast<const stbi_uc*>(bytes.data())),
        size(static_cast<int>(std::min(bytes.size(), kMaxStbBytes))) {
    max_pixels = std::min(max_pixels, bearable_pixels(bytes.size()));
    int channels = 0;
    guard_stb(bytes);
    if (!stbi_info_from_memory(data, size, &width, &height, &channels)) throw damaged();
    if (width <= 0 || height <= 0 || static_cast<uint64_t>(width) > max_pixels / static_cast<uint64_t>(height)) {
      throw Error("absurd size " + std::to_string(width) + "x" + std::to_string(height));
    }
  }
};

}  // namespace

std::string encode_png(const Image& image) {
  std::vector<uint8_t> bytes(image.rgb.size());
  std::transform(image.rgb.begin(), image.rgb.end(), bytes.begin(), [](float v) {
    if (!std::isfinite(v)) return uint8_t{0};
    return static_cast<uint8_t>(std::lround(255 * srgb_from_linear(std::clamp(v, 0.0f, 1.0f))));
  });
  std::string png;
  const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
  if (!stbi_write_png_to_func(append_to_string, &png, width, height, 3, bytes.data(), 3 * width))
    throw std::bad_alloc();
  return png;
}

Image decode_png(const std::string& bytes, uint64_t max_pixels) {
  if (!bytes.starts_with("\x89PNG")) throw Error("not a PNG file");
  Encoded in(bytes, max_pixels);
  int channels = 0;
  // 8-bit pictures pass through 16 bits exactly: v becomes 257 v.
  const std::unique_ptr<stbi_us, void (*)(void*)> pixels(
      stbi_load_16_from_memory(in.data, in.size, &in.width, &in.height, &channels, 3), &stbi_image_free);
  if (!pixels) throw damaged();
  static const std::vector<float> linear = linear_of_short();
  Image image(static_cast<uint32_t>(in.width), static_cast<uint32_t>(in.height));
  std::transform(pixels.get(), pixels.get() + image.rgb.size(), image.rgb.begin(), [](stbi_us v) { return linear[v]; });
  return image;
}

Texture decode_texture(const std::string& bytes, uint64_t max_pixels) {
  Encoded in(bytes, max_pixels);
  int channels = 0;
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(in.data, in.size, &in.width, &in.height, &channels, 3), &stbi_image_free);
  if (!pixels) throw damaged();
  Texture texture;
  texture.width = static_cast<uint32_t>(in.width);
  texture.height = static_cast<uint32_t>(in.height);
  texture.texels.resize(size_t{texture.width} * texture.height);
  for (size_t i = 0; i < texture.texels.size(); ++i) {
    const stbi_uc* rgb = pixels.get() + 3 * i;
    texture.texels[i] = rgb[0] | uint32_t{rgb[1]} << 8 | uint32_t{rgb[2]} << 16;
  }
  return texture;
}

}  // namespace lanewise
