#include "tools/output_files.h"

#include <filesystem>

#include "core/types.h"

namespace lanewise {

OutputFiles::OutputFiles(const RenderOptions& options) {
  keep(options.scene);
  if (!options.camera_file.empty()) keep(options.camera_file);
  if (!options.environment.empty()) keep(options.environment);
}

void OutputFiles::keep(const std::string& path) { taken_.push_back(path); }

void OutputFiles::add(const std::string& flag, const std::string& path) {
  const auto file_of = [](const std::string& name) {
    // Made absolute first: a file that is not there yet would keep its name as it is, and "a" not be "./a".
    std::error_code error;
    const std::filesystem::path file = std::filesystem::weakly_canonical(std::filesystem::absolute(name), error);
    return error ? std::filesystem::path(name) : file;
  };
  for (const std::string& other : taken_) {
    if (file_of(path) == file_of(other)) throw UsageError(flag + ": would overwrite " + other);
  }
  taken_.push_back(path);
}

}  // namespace lanewise
