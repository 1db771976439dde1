#include "scenes/obj_material.h"

#include <assimp/ObjMaterial.h>
#include <assimp/material.h>

#include "core/types.h"
#include "scenes/quoted.h"

namespace lanewise {
namespace {

constexpr double kGrey = 0.5;
constexpr double kNoKd = 0.6f;     // Assimp's where the file gives none
constexpr double kLargest = 1e15;  // squares and products up to this stay finite in float

class Reader {
 public:
  Reader(const std::string& path, const aiMaterial& from, Textures& textures, std::vector<std::string>& notices)
      : path_(path), from_(from), textures_(textures), notices_(notices) {
    material_.name = from.GetName().C_Str();
  }

  Material read() {
    int illum = 0;
    from_.Get(AI_MATKEY_OBJ_ILLUM, illum);
    material_.radiance = color("Ke", "$clr.emissive", 0, kLargest);
    if (material_.radiance != glm::dvec3(0.0)) {
      material_.kind = Material::Kind::kEmission;
      return material_;
    }
    const double ior = number("Ni", "$mat.refracti", 1, 100), opacity = number("d", "$mat.opacity", 1, 1);
    if (illum == 4 || illum == 6 || illum == 7 || (opacity < 1 && ior != 1)) {
      make_glass(ior);
    } else if (illum == 3 || illum == 5) {
      make_mirror();
    }
    if (material_.kind == Material::Kind::kDiffuse) make_diffuse(opacity);
    return material_;
  }

 private:
  void make_glass(double ior) {
    material_.kind = Material::Kind::kGlass;
    material_.reflectance = glm::dvec3(1.0);
    material_.transmittance = color("Tf", "$clr.transparent", 1, 1);
    material_.ior = ior;
    if (ior != 1) return;
    material_.ior = 1.5;
    notice("is glass without an index Ni: rendered with 1.5");
  }

  void make_mirror() {
    const glm::dvec3 specular = color("Ks", "$clr.specular", 0, 1);
    if (specular == glm::dvec3(0.0)) return;
    material_.kind = Material::Kind::kMirror;
    material_.reflectance = specular;
    const glm::dvec3 diffuse = color("Kd", "$clr.diffuse", 0, 1);
    if (diffuse == glm::dvec3(0.0) || diffuse == glm::dvec3(kNoKd)) return;
    notice("is a mirror: its diffuse part is left out");
  }

  void make_diffuse(double opacity) {
    if (from_.GetTextureCount(aiTextureType_DIFFUSE) > 0) {
      read_texture();
    } else {
      material_.reflectance = color("Kd", "$clr.diffuse", kGrey, 1);
    }
    if (opacity < 1) notice("is partly transparent: rendered opaque");
  }

  void read_texture() {
    aiString file;
    from_.GetTexture(aiTextureType_DIFFUSE, 0, &file);
    material_.texture = textures_.file(file.C_Str());
    if (material_.texture == kNoTexture) {
      material_.reflectance = glm::dvec3(kGrey);
      notice("is rendered as diffuse grey 0.5: its texture is missing");
      return;
    }
    const glm::dvec3 factor = color("Kd", "$clr.diffuse", 1, 1);
    material_.reflectance = factor == glm::dvec3(kNoKd) ? glm::dvec3(1) : factor;
  }

  double number(const char* name, const char* key, double otherwise, double most) const {
    float value = 0;
    if (from_.Get(key, 0, 0, value) != AI_SUCCESS) return otherwise;
    if (!(value >= 0 && value <= most)) fail(name, most);
    return value;
  }

  glm::dvec3 color(const char* name, const char* key, double otherwise, double most) const {
    aiColor3D value;
    if (from_.Get(key, 0, 0, value) != AI_SUCCESS) return glm::dvec3(otherwise);
    const glm::dvec3 found(value.r, value.g, value.b);
    for (int c = 0; c < 3; ++c) {
      if (!(found[c] >= 0 && found[c] <= most)) fail(name, most);
    }
    return found;
  }

  [[noreturn]] void fail(const char* name, double most) const {
    throw Error(
        path_ + ": material " + lanewise::quoted(material_.name) + ": " + name +
        (most == kLargest ? " is negative or too large" : " must be between 0 and " + std::to_string(int(most))));
  }

  void notice(const char* what) { notices_.push_back("material " + lanewise::quoted(material_.name) + ' ' + what); }

  const std::string& path_;
  const aiMaterial& from_;
  Textures& textures_;
  std::vector<std::string>& notices_;
  Material material_;
};

}  // namespace

Material read_obj_material(const std::string& path, const aiMaterial& from, Textures& textures,
                           std::vector<std::string>& notices) {
  return Reader(path, from, textures, notices).read();
}

}  // namespace lanewise
