#include "tools/rescue.h"

#include <cstdio>
#include <filesystem>
#include <random>
#include <system_error>

#include "core/file.h"
#include "core/types.h"

namespace lanewise {
namespace {

// Nobody else's, and ends as the file's own name does.
std::string place_for(const std::string& path) {
  constexpr size_t kLongest = 200;
  std::error_code error;
  std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (error) folder = "/tmp";
  std::string name = std::filesystem::path(path).filename().string();
  if (name.size() > kLongest) name = name.substr(name.size() - kLongest);
  char begin[32];
  std::snprintf(begin, sizeof begin, "lanewise-%08x-", std::random_device()());
  return (folder / (begin + name)).string();
}

}  // namespace

void Rescue::write(const std::string& path, const std::string& bytes) {
  try {
    write_file(path, bytes);
  } catch (const BrokenPipe& e) {
    broken_pipe_ = e.what();
  } catch (const Error& e) {
    keep(path, bytes, e.what());
  }
}

void Rescue::keep(const std::string& path, const std::string& bytes, const std::string& failure) {
  if (!failures_.empty()) failures_ += "; ";
  const std::string place = place_for(path);
  try {
    write_file(place, bytes);
    failures_ += failure + ": it is kept as " + place;
  } catch (const Error& e) {
    failures_ += failure + ", nor elsewhere: " + e.what();
  }
}

void Rescue::finish() const {
  if (!failures_.empty()) throw Error(failures_);
  if (!broken_pipe_.empty()) throw BrokenPipe(broken_pipe_);
}

}  // namespace lanewise
