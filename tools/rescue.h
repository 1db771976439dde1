// What a render has drawn outlives the folder that it was to be written to.
#pragma once

#include <string>

namespace lanewise {

// Writes a render's files, each whatever became of the others. One that cannot be written is kept in the folder for temporary
// files, under a name of its own.
class Rescue {
 public:
  void write(const std::string& path, const std::string& bytes);
  // Keeps a file that could not be written, for the reason that the failure tells.
  void keep(const std::string& path, const std::string& bytes, const std::string& failure);

  // When all is written. If some was not, throws Error with the reasons and where it is kept, or BrokenPipe if there is
  // nothing to tell but that nobody read it.
  void finish() const;

 private:
  std::string failures_;
  std::string broken_pipe_;
};

}  // namespace lanewise
