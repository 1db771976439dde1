#include "core/image_io.h"

#include <bit>
#include <cctype>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <new>
#include <stdexcept>

#include "core/file.h"
#include "core/image_exr.h"
#include "core/image_hdr.h"
#include "core/image_stb.h"
#include "core/types.h"

namespace lanewise {
namespace {

static_assert(std::endian::native == std::endian::little, "PFM is written with a negative scale: little-endian");

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
  if (width == 0 || height == 0 || width > kMostPixels / height) {
    throw Error("absurd size " + std::to_string(width) + "x" + std::to_string(height));
  }
}

std::string encode_pfm(const Image& image) {
  std::string pfm = "PF\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n-1.0\n";
  pfm.reserve(pfm.size() + image.rgb.size() * sizeof(float));
  for (uint32_t y = image.height; y-- > 0;) {
    pfm.append(reinterpret_cast<const char*>(image.pixel(0, y)), size_t{3} * image.width * sizeof(float));
  }
  return pfm;
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
  if (format == Format::kExr) return read_exr(path, kMostPixels);
  const std::string bytes =
      read_file(path, format == Format::kPng ? kMaxStbBytes : kMostPixels * 3 * sizeof(float) + 100);
  if (format == Format::kPng) return decode_png(bytes, kMostPixels);
  if (format == Format::kHdr) return decode_hdr(bytes, kMostPixels);
  return decode_pfm(bytes);
}

}  // namespace

bool holds_colours(const std::string& path) { return format_of(path) == Format::kPng; }

bool is_exr(const std::string& path) { return format_of(path) == Format::kExr; }

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
