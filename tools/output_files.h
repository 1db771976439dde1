// The files that a command writes, none of which may overwrite another or what the command reads.
#pragma once

#include <string>
#include <vector>

#include "tools/render_options.h"

namespace lanewise {

class OutputFiles {
 public:
  OutputFiles() = default;
  explicit OutputFiles(const RenderOptions& options);  // the scene and the camera are read

  // A file that is read.
  void keep(const std::string& path);
  // A file that the flag writes. Throws UsageError if it is among those named before.
  void add(const std::string& flag, const std::string& path);

 private:
  std::vector<std::string> taken_;
};

}  // namespace lanewise
