#include "core/image_hdr.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/types.h"

namespace lanewise {
namespace {

constexpr int kBias = 128 + 8;  // of the exponent, for mantissas that are whole numbers up to 255

void append_rgbe(const float* rgb, std::string& out) {
  const auto clean = [](float v) { return std::isfinite(v) ? std::clamp(v, 0.0f, 1e38f) : 0.0f; };
  const float r = clean(rgb[0]), g = clean(rgb[1]), b = clean(rgb[2]);
  const float largest = std::max({r, g, b});
  int exponent = 0;
  if (largest < 1e-32f) return void(out.append(4, '\0'));
  std::frexp(largest, &exponent);
  // The largest mantissa is 128 to 256, and 256 belongs to the next exponent.
  if (std::lround(std::ldexp(largest, 8 - exponent)) == 256) ++exponent;
  for (const float v : {r, g, b}) out.push_back(static_cast<char>(std::lround(std::ldexp(v, 8 - exponent))));
  out.push_back(static_cast<char>(exponent + 128));
}

// The next bytes of a file, which may end early.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  std::string_view line() {
    const size_t end = bytes_.find('\n');
    if (end == std::string_view::npos) throw Error("damaged picture (the header has no end)");
    return take(end + 1).substr(0, end);
  }
  std::string_view take(size_t n) {
    if (bytes_.size() < n) throw Error("damaged picture (the file ends early)");
    const std::string_view taken = bytes_.substr(0, n);
    bytes_.remove_prefix(n);
    return taken;
  }
  uint8_t byte() { return static_cast<uint8_t>(take(1)[0]); }
  bool next_line_is_run_length_encoded(uint32_t width) const {
    return width >= 8 && width < 0x8000 && bytes_.size() >= 4 && bytes_[0] == 2 && bytes_[1] == 2 && bytes_[2] >= 0;
  }
  size_t left() const { return bytes_.size(); }

 private:
  std::string_view bytes_;
};

// One scan line: four planes of width bytes for the encoded form, width times four for the flat one.
void read_line(Reader& in, uint32_t width, std::string& rgbe) {
  if (!in.next_line_is_run_length_encoded(width)) {
    rgbe = in.take(size_t{4} * width);
    return;
  }
  in.take(4);
  for (uint32_t plane = 0; plane < 4; ++plane) {
    for (uint32_t x = 0; x < width;) {
      const uint32_t code = in.byte();
      const bool run = code > 128;
      const uint32_t count = run ? code - 128 : code;
      if (count == 0 || count > width - x) throw Error("damaged picture (a run leaves its line)");
      const std::string_view values = in.take(run ? 1 : count);
      for (uint32_t i = 0; i < count; ++i) rgbe[size_t{4} * x++ + plane] = values[run ? 0 : i];
    }
  }
}

}  // namespace

std::string encode_hdr(const Image& image) {
  std::string out = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(image.height) + " +X " +
                    std::to_string(image.width) + "\n";
  // Flat lines: the encoded form saves nothing on noise, and a mantissa of at least 128 in every pixel that is not
  // black keeps them from being taken for it.
  out.reserve(out.size() + image.rgb.size() / 3 * 4);
  for (size_t i = 0; i < image.rgb.size(); i += 3) append_rgbe(&image.rgb[i], out);
  return out;
}

Image decode_hdr(std::string_view bytes, uint64_t max_pixels) {
  Reader in(bytes);
  const std::string_view magic = in.line();
  if (magic != "#?RADIANCE" && magic != "#?RGBE") throw Error("not a Radiance HDR file");
  bool rgbe = false;
  for (std::string_view line = in.line(); !line.empty(); line = in.line())
    rgbe = rgbe || line == "FORMAT=32-bit_rle_rgbe";
  if (!rgbe) throw Error("not an RGBE file");
  uint32_t width = 0, height = 0;
  char end = 0;
  if (std::sscanf(std::string(in.line()).c_str(), "-Y %9u +X %9u%c", &height, &width, &end) != 2) {
    throw Error("unknown orientation or size");
  }
  // Even the shortest encoding takes four bytes for 127 pixels.
  if (width == 0 || height == 0 || width > max_pixels / height || uint64_t{width} * height / 127 > in.left()) {
    throw Error("absurd size " + std::to_string(width) + "x" + std::to_string(height));
  }
  Image image(width, height);
  std::string line(size_t{4} * width, '\0');
  for (uint32_t y = 0; y < height; ++y) {
    read_line(in, width, line);
    for (uint32_t x = 0; x < width; ++x) {
      const auto* pixel = reinterpret_cast<const uint8_t*>(&line[size_t{4} * x]);
      const float scale = pixel[3] == 0 ? 0.0f : std::ldexp(1.0f, pixel[3] - kBias);
      for (uint32_t c = 0; c < 3; ++c) image.pixel(x, y)[c] = static_cast<float>(pixel[c]) * scale;
    }
  }
  return image;
}

}  // namespace lanewise
