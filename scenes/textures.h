// The textures of a scene that is being read, each once.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "core/scene.h"

namespace lanewise {

class Textures {
 public:
  explicit Textures(Scene& scene) : scene_(scene) {}  // must outlive the object, its path be set

  // The index in the scene of the picture that it calls by that name: a file of its own folder (see find_own_file). kNoTexture,
  // with a notice, if there is none. Throws Error, naming the file, for one that cannot be read.
  uint32_t file(const std::string& name);

  // The same of a picture in memory, whose name tells it from others.
  uint32_t embedded(const std::string& name, const std::string& bytes);

 private:
  Texture decode(const std::string& bytes);
  uint32_t add(Texture texture, const std::string& name);

  Scene& scene_;
  std::map<std::string, uint32_t> known_;
  uint64_t bytes_ = 0, texels_ = 0;  // of the files read so far, and of what they hold
};

}  // namespace lanewise
