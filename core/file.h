// Whole files: read at once, and written so that they are either whole or not there.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/types.h"

namespace lanewise {

// Thrown where nobody reads any more what is written to a pipe, which is for whoever reads it to know and no fault of a file.
struct BrokenPipe : Error {
  using Error::Error;
};

// Throws Error, naming the path, if no file can be written there (no such folder, a folder itself, no permission). For
// the command line to call before a long render; creates nothing.
void check_writable(const std::string& path);

// Writes to a temporary file beside the path, syncs it and renames it over the path, so that a file that stands there
// is replaced whole or left as it is. Links are followed (one that leads nowhere is replaced); devices and pipes are
// written to directly. Throws Error (BrokenPipe for such a pipe) with the path and the reason, and leaves no temporary file
// behind.
void write_file(const std::string& path, std::string_view bytes);

// The bytes of a file of at most max_bytes. Throws Error with the reason, without the path.
std::string read_file(const std::string& path, uint64_t max_bytes);

// Keeps other processes that ask for the same from a file, by a lock on PATH.lock beside it, until it is destroyed or the process
// ends, however it does. Throws Error, naming the path, if another one has it.
class FileLock {
 public:
  explicit FileLock(const std::string& path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  std::string lock_;
  int fd_;
};

}  // namespace lanewise
