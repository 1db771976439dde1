// The files that Assimp may read: a scene and what it refers to in its own folder.
#pragma once

#include <assimp/IOSystem.hpp>
#include <string>
#include <vector>

namespace lanewise {

// Files are read whole, into memory, and none is written. What a scene names outside its folder, also by way of a link,
// does not exist for it.
class SceneFiles : public Assimp::IOSystem {
 public:
  // text: what stands for the scene's own file; preamble: what every other file is made to begin with; missed gets a line for
  // each file that could not be read. All arguments but the preamble must outlive the object.
  SceneFiles(const std::string& path, const std::string& text, std::string preamble, std::vector<std::string>& missed);

  bool Exists(const char* file) const override;
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override;  // null where there is none
  void Close(Assimp::IOStream* stream) override;

 private:
  const std::string& path_;
  const std::string& text_;
  const std::string preamble_;
  std::vector<std::string>& missed_;
};

}  // namespace lanewise
