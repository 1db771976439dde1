#include "core/image_io.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <new>
#include <stdexcept>

#include "core/file.h"
#include "core/image_exr.h"
#include "core/image_hdr.h"
#include "core/srgb.h"
#include "core/types.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#include <stb/stb_image.h>
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace lanewise {
namespace {

static_assert(std::endian::native == std::endian::little, "PFM is written with a negative scale: little-endian");

constexpr uint64_t kMaxPixels = uint64_t{1} << 28;
constexpr uint64_t kMaxPngBytes = 0x7FFFFFFF;  // stb counts in int

enum class Format { kPng, kExr, kPfm, kHdr };

Format format_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".png") return Format::kPng;
  if (extension == ".exr") return Format::kExr;
  if (extension == ".pfm") return Format::kPfm;
  if (extension == ".hdr") return Format::kHdr;
  throw UsageError(path + ": a picture's name must end in .png, .exr, .pfm or .hdr");
}

void check_size(uint64_t width, uint64_t height) {
  if (width == 0 || height == 0 || width > kMaxPixels / height) {
    throw Error("absurd size " + std::to_string(width) + "x" + std::to_string(height));
  }
}

void append_to_string(void* context, void* data, int size) {
  static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<size_t>(size));
}

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

std::string encode_pfm(const Image& image) {
  std::string pfm = "PF\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n-1.0\n";
  pfm.reserve(pfm.size() + image.rgb.size() * sizeof(float));
  for (uint32_t y = image.height; y-- > 0;) {
    pfm.append(reinterpret_cast<const char*>(image.pixel(0, y)), size_t{3} * image.width * sizeof(float));
  }
  return pfm;
}

Image decode_png(const std::string& bytes) {
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const int size = static_cast<int>(bytes.size());
  const auto damaged = [] { return Error(std::string("damaged picture (") + stbi_failure_reason() + ")"); };
  int width = 0, height = 0, channels = 0;
  if (!stbi_info_from_memory(data, size, &width, &height, &channels)) throw damaged();
  check_size(static_cast<uint64_t>(width), static_cast<uint64_t>(height));
  // 8-bit pictures pass through 16 bits exactly: v becomes 257 v.
  const std::unique_ptr<stbi_us, void (*)(void*)> pixels(
      stbi_load_16_from_memory(data, size, &width, &height, &channels, 3), &stbi_image_free);
  if (!pixels) throw damaged();
  std::vector<float> linear(65536);
  for (size_t v = 0; v < linear.size(); ++v)
    linear[v] = static_cast<float>(linear_from_srgb(static_cast<double>(v) / 65535));
  Image image(static_cast<uint32_t>(width), static_cast<uint32_t>(height));
  std::transform(pixels.get(), pixels.get() + image.rgb.size(), image.rgb.begin(),
                 [&](stbi_us v) { return linear[v]; });
  return image;
}

Image decode_pfm(const std::string& bytes) {
  char kind = 0;
  uint32_t width = 0, height = 0;
  float scale = 0;
  int header = 0;
  if (std::sscanf(bytes.substr(0, 100).c_str(), "P%c %9u %9u %f%n", &kind, &width, &height, &scale, &header) != 4 ||
      (kind != 'F' && kind != 'f') || !(scale > 0 || scale < 0)) {
    throw Error("not a PFM file");
  }
  check_size(width, height);
  const size_t channels = kind == 'F' ? 3 : 1;
  const size_t row = channels * width * sizeof(float);
  const size_t begin = static_cast<size_t>(header) + 1;  // one white space ends the header
  if (bytes.size() < begin + row * height) throw Error("damaged picture (the file ends early)");

  Image image(width, height);
  for (uint32_t y = 0; y < height; ++y) {
    const char* source = bytes.data() + begin + row * (height - 1 - y);
    for (size_t i = 0; i < size_t{3} * width; ++i) {
      uint32_t bits;
      std::memcpy(&bits, source + (channels == 3 ? i : i / 3) * sizeof bits, sizeof bits);
      image.pixel(0, y)[i] = std::bit_cast<float>(scale < 0 ? bits : __builtin_bswap32(bits));
    }
  }
  return image;
}

Image read_any(const std::string& path) {
  const Format format = format_of(path);
  if (format == Format::kExr) {
    if (std::filesystem::is_directory(path)) throw Error("Is a directory");
    return read_exr(path, kMaxPixels);
  }
  const std::string bytes =
      read_file(path, format == Format::kPng ? kMaxPngBytes : kMaxPixels * 3 * sizeof(float) + 100);
  if (format == Format::kPng) return decode_png(bytes);
  if (format == Format::kHdr) return decode_hdr(bytes, kMaxPixels);
  return decode_pfm(bytes);
}

}  // namespace

bool holds_colours(const std::string& path) { return format_of(path) == Format::kPng; }

void check_image_extension(const std::string& path) { format_of(path); }

void check_image_writable(const std::string& path) { check_writable(path); }

std::string encode_image(const std::string& path, const Image& image,
                         const std::vector<std::pair<std::string, std::string>>& metadata) {
  switch (format_of(path)) {
    case Format::kPng:
      return encode_png(image);
    case Format::kHdr:
      return encode_hdr(image);
    case Format::kPfm:
      return encode_pfm(image);
    case Format::kExr:
      return encode_exr(image, metadata);
  }
  throw std::logic_error("format");
}

void write_image(const std::string& path, const Image& image,
                 const std::vector<std::pair<std::string, std::string>>& metadata) {
  write_file(path, encode_image(path, image, metadata));
}

Image read_image(const std::string& path) {
  check_image_extension(path);
  try {
    return read_any(path);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    throw Error(path + ": cannot read: " + e.what());
  }
}

}  // namespace lanewise
