#include "core/image_exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>

#include <algorithm>

#include "core/exr_input.h"
#include "core/exr_slice.h"
#include "core/types.h"

namespace lanewise {
namespace {

constexpr int64_t kMaxSide = 1 << 17;  // OpenEXR's own buffers hold up to 256 rows each
constexpr uint64_t kHeaderBytes = 1 << 26;
constexpr int64_t kBandPixels = 1 << 20;
constexpr const char* kChannels[] = {"R", "G", "B"};

Imf::Slice slice(const Image& image, size_t c, int64_t x, int64_t y) {
  return exr_slice(Imf::FLOAT, image.rgb.data() + c, 3 * sizeof(float), x, y, image.width);
}

}  // namespace

std::string encode_exr(const Image& image, const std::vector<std::pair<std::string, std::string>>& metadata) {
  Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const auto& [key, value] : metadata) header.insert(key, Imf::StringAttribute(value));
  Imf::FrameBuffer frame;
  for (size_t c = 0; c < 3; ++c) {
    header.channels().insert(kChannels[c], Imf::Channel(Imf::FLOAT));
    frame.insert(kChannels[c], slice(image, c, 0, 0));
  }
  // Through memory: OpenEXR writes its table of lines in a destructor, where a full disk would pass unnoticed.
  Imf::StdOSStream stream;
  {
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(frame);
    file.writePixels(static_cast<int>(image.height));
  }
  return stream.str();
}

Image read_exr(const std::string& path, uint64_t max_pixels) {
  ExrInput in(path, kHeaderBytes + max_pixels * 3 * sizeof(float));
  const Imath::Box2i window = in.header().dataWindow();
  const int64_t width = int64_t{window.max.x} - window.min.x + 1, height = int64_t{window.max.y} - window.min.y + 1;
  if (width <= 0 || height <= 0 || width > kMaxSide ||
      static_cast<uint64_t>(width) > max_pixels / static_cast<uint64_t>(height)) {
    throw Error("absurd size " + std::to_string(width) + "x" + std::to_string(height));
  }
  const Imf::ChannelList& channels = in.header().channels();
  const bool grey = channels.findChannel("Y") && !channels.findChannel("R");
  if (!grey && !channels.findChannel("R") && !channels.findChannel("G") && !channels.findChannel("B")) {
    throw Error("no channel R, G, B or Y");
  }
  Image image;
  image.width = static_cast<uint32_t>(width);
  image.height = static_cast<uint32_t>(height);
  // Some rows at a time, so that a small file that claims to hold a large picture fails before memory is used for it.
  const int64_t band = std::max<int64_t>(1, kBandPixels / width);
  for (int64_t y = 0; y < height; y += band) {
    const int64_t end = std::min(y + band, height);
    image.rgb.resize(static_cast<size_t>(3 * width * end));
    Imf::FrameBuffer frame;  // rows that were read may have moved
    for (size_t c = 0; c < (grey ? 1 : 3); ++c) {
      frame.insert(grey ? "Y" : kChannels[c], slice(image, c, window.min.x, window.min.y));
    }
    in.file().setFrameBuffer(frame);
    in.file().readPixels(static_cast<int>(window.min.y + y), static_cast<int>(window.min.y + end - 1));
  }
  if (grey) {
    for (size_t i = 0; i < image.rgb.size(); i += 3) image.rgb[i + 1] = image.rgb[i + 2] = image.rgb[i];
  }
  return image;
}

}  // namespace lanewise
