// A glTF 2.0 file (.gltf, or .glb in one piece) before its geometry is read: checked, and stripped to what that needs.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/scene.h"
#include "scenes/json_value.h"

namespace lanewise {

// Assimp 5.2 knows neither KHR_materials_emissive_strength nor which of a file's materials one of its own was, and
// trusts many numbers of a file. So materials and cameras are read here, and geometry() hands over the rest alone, with
// nodes and materials named by their index: "node 3", "material 7".
class GltfDocument {
 public:
  // Both arguments must outlive the document. Throws Error for broken JSON or chunks, versions other than 2, required
  // extensions that are not understood, references that lead nowhere, nodes that are no tree or are nested more than
  // 1000 deep, and accessors that reach beyond their buffers.
  GltfDocument(const std::string& path, const std::string& text);

  // The file with which geometry is left, in the form that the original has. Of texture coordinates there is one set: that
  // which the material's base colour asks for.
  std::string geometry() const;

  const std::string& path() const { return path_; }
  JsonValue root() const { return {path_, json_}; }
  std::string_view binary_chunk() const;     // the bytes after the JSON of a .glb, or none
  std::vector<std::string> notices() const;  // what of the file is not rendered

  // Of a name that geometry() gave; nothing for other names.
  std::optional<size_t> node_index(const std::string& name) const { return index_of(name, "node "); }
  std::optional<size_t> material_index(const std::string& name) const { return index_of(name, "material "); }

 private:
  void read_chunks();
  void parse(std::string_view json);
  static std::optional<size_t> index_of(const std::string& name, std::string_view prefix);

  const std::string& path_;
  const std::string& text_;
  nlohmann::json json_;
  std::string_view chunks_;  // those of a .glb that follow the JSON
  bool binary_ = false;
};

}  // namespace lanewise
