#include "scenes/assimp_files.h"

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "core/file.h"
#include "core/types.h"
#include "scenes/own_file.h"
#include "scenes/quoted.h"

namespace lanewise {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t kMaxFileBytes = uint64_t{4} << 30;

class MemoryStream : public Assimp::IOStream {
 public:
  explicit MemoryStream(std::string_view bytes) : bytes_(bytes) {}
  explicit MemoryStream(std::string owned) : owned_(std::move(owned)), bytes_(owned_) {}

  size_t Read(void* to, size_t size, size_t count) override {
    if (size == 0) return 0;
    const size_t whole = std::min(count, (bytes_.size() - at_) / size);
    std::memcpy(to, bytes_.data() + at_, whole * size);
    at_ += whole * size;
    return whole;
  }
  size_t Write(const void*, size_t, size_t) override { return 0; }
  aiReturn Seek(size_t offset, aiOrigin origin) override {
    const size_t from = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at_ : bytes_.size();
    const size_t to = from + offset;  // an offset below 0 wraps around
    if (to > bytes_.size()) return aiReturn_FAILURE;
    at_ = to;
    return aiReturn_SUCCESS;
  }
  size_t Tell() const override { return at_; }
  size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  std::string owned_;
  std::string_view bytes_;
  size_t at_ = 0;
};

}  // namespace

SceneFiles::SceneFiles(const std::string& path, const std::string& text, std::string preamble,
                       std::vector<std::string>& missed)
    : path_(path), text_(text), preamble_(std::move(preamble)), missed_(missed) {}

bool SceneFiles::Exists(const char* file) const { return file == path_ || is_own_file(path_, file); }

Assimp::IOStream* SceneFiles::Open(const char* file, const char* mode) {
  if (std::strpbrk(mode, "wa+") != nullptr) return nullptr;
  if (file == path_) return new MemoryStream(std::string_view(text_));
  std::string reason = "is no file in the scene's folder";
  if (is_own_file(path_, file)) {
    try {
      return new MemoryStream(preamble_ + read_file(file, kMaxFileBytes));
    } catch (const Error& e) {
      reason = e.what();
    }
  }
  missed_.push_back(lanewise::quoted(fs::path(file).filename().string()) + ' ' + reason + ": not read");
  return nullptr;
}

void SceneFiles::Close(Assimp::IOStream* stream) { delete stream; }

}  // namespace lanewise
