#include "core/image_exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>

#include "core/types.h"

namespace lanewise {
namespace {

constexpr const char* kChannels[] = {"R", "G", "B"};

// Where OpenEXR finds channel c of the pixel (x, y) of its data window: base + x stride + y stride.
Imf::Slice slice(float* rgb, size_t c, int64_t min_x, int64_t min_y, size_t width) {
  const size_t x_stride = 3 * sizeof(float), y_stride = x_stride * width;
  const int64_t first = min_x * static_cast<int64_t>(x_stride) + min_y * static_cast<int64_t>(y_stride);
  // As integers: the base of a window that does not begin at 0 lies outside the array, where no pointer may point.
  const auto base = reinterpret_cast<intptr_t>(rgb + c) - first;
  return {Imf::FLOAT, reinterpret_cast<char*>(base), x_stride, y_stride};
}

}  // namespace

std::string encode_exr(const Image& image, const std::vector<std::pair<std::string, std::string>>& metadata) {
  Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const auto& [key, value] : metadata) header.insert(key, Imf::StringAttribute(value));
  Imf::FrameBuffer frame;
  for (size_t c = 0; c < 3; ++c) {
    header.channels().insert(kChannels[c], Imf::Channel(Imf::FLOAT));
    frame.insert(kChannels[c], slice(const_cast<float*>(image.rgb.data()), c, 0, 0, image.width));
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
  Imf::InputFile file(path.c_str());
  const Imath::Box2i window = file.header().dataWindow();
  const int64_t width = int64_t{window.max.x} - window.min.x + 1, height = int64_t{window.max.y} - window.min.y + 1;
  if (width <= 0 || height <= 0 || static_cast<uint64_t>(width) > max_pixels / static_cast<uint64_t>(height)) {
    throw Error("absurd size " + std::to_string(width) + "x" + std::to_string(height));
  }
  const Imf::ChannelList& channels = file.header().channels();
  const bool grey = channels.findChannel("Y") && !channels.findChannel("R");
  if (!grey && !channels.findChannel("R") && !channels.findChannel("G") && !channels.findChannel("B")) {
    throw Error("no channel R, G, B or Y");
  }
  Image image(static_cast<uint32_t>(width), static_cast<uint32_t>(height));
  Imf::FrameBuffer frame;
  for (size_t c = 0; c < (grey ? 1 : 3); ++c) {
    frame.insert(grey ? "Y" : kChannels[c], slice(image.rgb.data(), c, window.min.x, window.min.y, image.width));
  }
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);
  if (grey) {
    for (size_t i = 0; i < image.rgb.size(); i += 3) image.rgb[i + 1] = image.rgb[i + 2] = image.rgb[i];
  }
  return image;
}

}  // namespace lanewise
