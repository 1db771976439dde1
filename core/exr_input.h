// An OpenEXR file from anyone, opened without trust.
#pragma once

#include <ImfIO.h>
#include <ImfInputFile.h>

#include <cstdint>
#include <memory>
#include <string>

namespace lanewise {

class ExrInput {
 public:
  // Reads the file, at most max_bytes of it, and checks its header before OpenEXR sees it. Throws Error with the reason, without the
  // path, or what OpenEXR throws.
  ExrInput(const std::string& path, uint64_t max_bytes);

  Imf::InputFile& file() { return *file_; }
  const Imf::Header& header() const { return file_->header(); }

 private:
  std::string bytes_;
  std::unique_ptr<Imf::IStream> stream_;
  std::unique_ptr<Imf::InputFile> file_;
};

}  // namespace lanewise
