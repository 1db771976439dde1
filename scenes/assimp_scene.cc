#include "scenes/assimp_scene.h"

#include <assimp/BaseImporter.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "core/types.h"
#include "scenes/assimp_files.h"
#include "scenes/assimp_mesh.h"
#include "scenes/default_camera.h"
#include "scenes/gltf_camera.h"
#include "scenes/gltf_document.h"
#include "scenes/gltf_image.h"
#include "scenes/gltf_material.h"
#include "scenes/obj_material.h"
#include "scenes/placing.h"
#include "scenes/ply_header.h"
#include "scenes/quoted.h"

#if defined(__SANITIZE_ADDRESS__) || defined(LANEWISE_FUZZ)
// Assimp 5.2 loses what it has read of an OBJ or PLY file when it gives up on the file.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libassimp\n"; }
#endif

namespace lanewise {
namespace {

constexpr size_t kMaxTriangles = size_t{1} << 26;
constexpr size_t kMaxCopies = size_t{1} << 23;  // of triangles: a small file may ask for no more than that
constexpr size_t kLongestName = 256;            // whatever is instanced has a copy

// Assimp 5.2 writes to no material, and so to no memory, what a .mtl says before its first newmtl.
constexpr const char* kNoMaterial = "newmtl none\n";

enum class Format { kObj, kPly, kGltf };

// The name ends in one of the four, in any case.
Format format_of(const std::string& path) {
  switch (path[path.rfind('.') + 1] | 0x20) {
    case 'o':
      return Format::kObj;
    case 'p':
      return Format::kPly;
    default:
      return Format::kGltf;
  }
}

glm::dmat4 to_dmat4(const aiMatrix4x4& m) {
  return {m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2, m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4};
}

// Otherwise a file could pass for one of the forty other formats, whatever its name says.
void keep_one_format(Assimp::Importer& importer, const std::string& extension) {
  for (size_t i = importer.GetImporterCount(); i-- > 0;) {
    Assimp::BaseImporter* format = importer.GetImporter(i);
    std::set<std::string> extensions;
    format->GetExtensionList(extensions);
    if (extensions.contains(extension)) continue;
    importer.UnregisterLoader(format);
    delete format;
  }
}

class Loader {
 public:
  Loader(const std::string& path, const std::string& text) : path_(path), text_(text), format_(format_of(path)) {
    scene_.path = path;
    scene_.up = {0, 1, 0};
  }

  Scene load() {
    if (text_.empty()) throw Error(path_ + ": is empty");
    if (format_ == Format::kGltf) {
      gltf_.emplace(path_, text_);
      images_.emplace(*gltf_, textures_);
      for (const std::string& text : gltf_->notices()) notice(text);
    }
    const std::string checked = gltf_ ? gltf_->geometry() : format_ == Format::kPly ? checked_ply(path_, text_) : "";
    Assimp::Importer importer;
    keep_one_format(importer, format_ == Format::kObj ? "obj" : format_ == Format::kPly ? "ply" : "gltf");
    const bool obj = format_ == Format::kObj;
    importer.SetIOHandler(  // the importer deletes it
        new SceneFiles(path_, obj ? text_ : checked, obj ? kNoMaterial : "", missed_));
    assimp_ = importer.ReadFile(path_, 0);
    // Materials may be missing, geometry not.
    if (gltf_ && !missed_.empty()) throw Error(path_ + ": " + missed_.front());
    for (const std::string& text : missed_) notice(text);
    if (assimp_ == nullptr || assimp_->mRootNode == nullptr) fail(importer.GetErrorString());
    visit(*assimp_->mRootNode, glm::dmat4(1.0));
    if (scene_.meshes.empty()) throw Error(path_ + ": the scene has no geometry");
    if (scene_.cameras.empty()) {
      scene_.cameras.push_back(default_camera(scene_));
      notice("no camera in the file: seen from the front, 10 degrees above, all in view");
    }
    finish_scene(scene_);
    return std::move(scene_);
  }

 private:
  [[noreturn]] void fail(std::string reason) const {
    std::ranges::replace_if(
        reason, [](unsigned char c) { return c < ' '; }, ' ');
    throw Error(path_ + ": cannot be read: " + (reason.empty() ? "its contents are broken" : reason));
  }

  void visit(const aiNode& node, const glm::dmat4& parent_to_world) {
    const glm::dmat4 to_world = parent_to_world * to_dmat4(node.mTransformation);
    const std::optional<size_t> index = gltf_ ? gltf_->node_index(node.mName.C_Str()) : std::nullopt;
    const std::string name = index ? gltf_->root()["nodes"].at(*index)["name"].text("") : node.mName.C_Str();
    if (!invertible(to_world)) {
      throw Error(path_ + ": the transform of node " + lanewise::quoted(name) +
                  ", with those around it, is singular or too large");
    }
    for (uint32_t i = 0; i < node.mNumMeshes; ++i) add_mesh(node.mMeshes[i], name, to_world);
    if (index) add_camera(gltf_->root()["nodes"].at(*index), name, to_world);
    for (uint32_t i = 0; i < node.mNumChildren; ++i) visit(*node.mChildren[i], to_world);
  }

  void add_mesh(uint32_t index, const std::string& name, const glm::dmat4& to_world) {
    const aiMesh& from = *assimp_->mMeshes[index];
    const auto [read, is_new] = meshes_.try_emplace(index);
    if (is_new) {
      read->second = read_mesh(path_, from);
      if ((from.mPrimitiveTypes & (aiPrimitiveType_POINT | aiPrimitiveType_LINE)) != 0)
        notice("points and lines are skipped");
      if (from.HasVertexColors(0)) notice("vertex colours are not read");
    }
    if (read->second.triangles.empty()) return;
    if (is_new) own_triangles_ += read->second.triangles.size();
    triangles_ += read->second.triangles.size();
    if (triangles_ > kMaxTriangles) throw Error(path_ + ": more than 2^26 triangles, instances counted");
    if (triangles_ > kMaxCopies + own_triangles_) {
      throw Error(path_ + ": more than 2^23 triangles beyond the file's own, by instances");
    }
    scene_.meshes.push_back(read->second);
    Mesh& mesh = scene_.meshes.back();
    mesh.name = name.substr(0, kLongestName);
    place_mesh(mesh, to_world);
    mesh.material = material(from.mMaterialIndex);
  }

  void add_camera(const JsonValue& node, const std::string& name, const glm::dmat4& to_world) {
    if (!node["camera"].present()) return;
    const JsonValue from = gltf_->root()["cameras"].at(node["camera"].index(gltf_->root()["cameras"]));
    if (from["type"].text("perspective") != "perspective") {
      notice("camera " + lanewise::quoted(name) + " is not a perspective one: skipped");
      return;
    }
    scene_.cameras.push_back(read_gltf_camera(from, to_world));
    if (scene_.cameras.back().name.empty()) scene_.cameras.back().name = name;
  }

  // The index in the scene of Assimp's material.
  uint32_t material(uint32_t index) {
    const auto [place, is_new] = materials_.try_emplace(index, static_cast<uint32_t>(scene_.materials.size()));
    if (is_new) scene_.materials.push_back(read_material(*assimp_->mMaterials[index]));
    return place->second;
  }

  Material read_material(const aiMaterial& from) {
    const std::string name = from.GetName().C_Str();
    std::vector<std::string> notices;
    Material material;
    if (const auto index = gltf_ ? gltf_->material_index(name) : std::nullopt) {
      const auto texture_of = [&](const JsonValue& info) { return images_->texture(info, notices); };
      material = read_gltf_material(gltf_->root()["materials"].at(*index), texture_of, notices);
    } else if (format_ == Format::kObj && name != AI_DEFAULT_MATERIAL_NAME) {
      material = read_obj_material(path_, from, textures_, notices);
    } else {
      material.name = "default";
      material.reflectance = glm::dvec3(0.5);
      notices.push_back("what has no material is rendered as diffuse grey 0.5");
    }
    for (const std::string& text : notices) notice(text);
    return material;
  }

  void notice(const std::string& text) {
    if (notices_.insert(text).second) scene_.notices.push_back(text);
  }

  const std::string& path_;
  const std::string& text_;
  const Format format_;
  std::optional<GltfDocument> gltf_;
  const aiScene* assimp_ = nullptr;
  Scene scene_;
  Textures textures_{scene_};
  std::optional<GltfImages> images_;
  std::map<uint32_t, Mesh> meshes_;  // in their own spaces, by Assimp's index
  std::map<uint32_t, uint32_t> materials_;
  std::vector<std::string> missed_;  // files that could not be read
  std::set<std::string> notices_;
  size_t triangles_ = 0, own_triangles_ = 0;  // the last without those of later instances
};

}  // namespace

Scene load_assimp(const std::string& path, const std::string& text) { return Loader(path, text).load(); }

}  // namespace lanewise
