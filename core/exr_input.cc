#include "core/exr_input.h"

#include <ImfHeader.h>

#include <cstring>
#include <filesystem>
#include <string_view>

#include "core/exr_header.h"
#include "core/file.h"
#include "core/types.h"

namespace lanewise {
namespace {

constexpr int64_t kMaxTileSide = 1 << 12, kMaxTileRow = 1 << 26;  // OpenEXR keeps whole rows of tiles

class MemoryStream : public Imf::IStream {
 public:
  MemoryStream(const std::string& name, std::string_view bytes) : IStream(name.c_str()), bytes_(bytes) {}

  // Whether anything is left.
  bool read(char* to, int count) override {
    if (count < 0 || static_cast<size_t>(count) > bytes_.size() - at_)
      throw Error("damaged picture (the file ends early)");
    std::memcpy(to, bytes_.data() + at_, static_cast<size_t>(count));
    at_ += static_cast<size_t>(count);
    return at_ < bytes_.size();
  }
  uint64_t tellg() override { return at_; }
  void seekg(uint64_t to) override {
    if (to > bytes_.size()) throw Error("damaged picture (it refers beyond the file's end)");
    at_ = to;
  }

 private:
  std::string_view bytes_;
  size_t at_ = 0;
};

}  // namespace

ExrInput::ExrInput(const std::string& path, uint64_t max_bytes) {
  if (std::filesystem::is_directory(path)) throw Error("Is a directory");
  if (std::filesystem::exists(path) && !std::filesystem::is_regular_file(path)) throw Error("not a regular file");
  bytes_ = read_file(path, max_bytes);
  check_exr_header(bytes_);
  Imf::Header::setMaxTileSize(kMaxTileSide, kMaxTileSide);
  stream_ = std::make_unique<MemoryStream>(path, bytes_);
  file_ = std::make_unique<Imf::InputFile>(*stream_);
  const Imath::Box2i window = header().dataWindow();
  const int64_t width = int64_t{window.max.x} - window.min.x + 1;
  if (header().hasTileDescription() && width * header().tileDescription().ySize > kMaxTileRow)
    throw Error("absurdly large tiles");
}

}  // namespace lanewise
