// The pictures of a glTF file: files of their own, in a buffer, or in a data: URI.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/gltf_document.h"
#include "scenes/textures.h"

namespace lanewise {

class GltfImages {
 public:
  // Both must outlive the object.
  GltfImages(const GltfDocument& document, Textures& textures) : document_(document), textures_(textures) {}

  // The texture of the scene that a textureInfo ("baseColorTexture") means; kNoTexture if its picture is missing or of a
  // kind that is not read, which the notices tell. Throws Error for references that lead nowhere and damaged pictures.
  uint32_t texture(const JsonValue& info, std::vector<std::string>& notices);

 private:
  uint32_t image(size_t index, std::vector<std::string>& notices);
  std::string_view buffer(const JsonValue& list, size_t index);

  const GltfDocument& document_;
  Textures& textures_;
  std::map<size_t, std::string> buffers_;  // those from files and URIs
};

}  // namespace lanewise
