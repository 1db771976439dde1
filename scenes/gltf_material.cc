#include "scenes/gltf_material.h"

#include <algorithm>
#include <cmath>

#include "scenes/quoted.h"

namespace lanewise {
namespace {

constexpr double kLargest = 1e15;           // squares and products up to this stay finite in float
constexpr double kMostReflectance = 0.999;  // of a metal; at 1 its index is 0
constexpr double kLeastAlpha = 1e-4;        // smoother is a mirror
constexpr double kTexture = 0.5;            // in place of a texture's values

double share(const JsonValue& value, double otherwise) {
  const double found = value.number(otherwise);
  if (!(found >= 0 && found <= 1)) value.fail("must be between 0 and 1");
  return found;
}

glm::dvec3 color(const JsonValue& value, double otherwise, double most) {
  const glm::dvec3 found = value.color(glm::dvec3(otherwise));
  for (int c = 0; c < 3; ++c) {
    if (!(found[c] >= 0 && found[c] <= most)) {
      value.fail(most == 1 ? "must be between 0 and 1" : "is negative or too large");
    }
  }
  return found;
}

void read_emission(const JsonValue& m, Material& material) {
  const JsonValue strength = m["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"];
  const double times = strength.number(1);
  if (!(times >= 0 && times <= kLargest)) strength.fail("is negative or too large");
  material.radiance = times * color(m["emissiveFactor"], 0, 1);
  if (material.radiance != glm::dvec3(0.0)) material.kind = Material::Kind::kEmission;
}

void make_metal(const glm::dvec3& reflectance, double alpha, Material& material) {
  if (alpha < kLeastAlpha) {
    material.kind = Material::Kind::kMirror;
    material.reflectance = reflectance;
    return;
  }
  material.kind = Material::Kind::kMicrofacet;
  material.alpha = alpha;
  for (int c = 0; c < 3; ++c) metal_of_reflectance(reflectance[c], material.eta[c], material.k[c]);
}

void make_glass(const JsonValue& m, const glm::dvec3& tint, Material& material) {
  const JsonValue ior = m["extensions"]["KHR_materials_ior"]["ior"];
  material.kind = Material::Kind::kGlass;
  material.reflectance = glm::dvec3(1.0);
  material.transmittance = tint;
  material.ior = ior.number(1.5);
  if (!(material.ior >= 1 && material.ior <= 100)) ior.fail("must be from 1 to 100");
}

bool has_other_textures(const JsonValue& m) {
  return m["pbrMetallicRoughness"]["metallicRoughnessTexture"].present() || m["emissiveTexture"].present() ||
         m["normalTexture"].present() || m["extensions"]["KHR_materials_transmission"]["transmissionTexture"].present();
}

}  // namespace

void metal_of_reflectance(double reflectance, double& eta, double& k) {
  const double r = std::min(reflectance, kMostReflectance), root = std::sqrt(r);
  const double tint = 1 - std::pow(1 - r, 2.7);
  eta = tint * (1 - r) / (1 + r) + (1 - tint) * (1 + root) / (1 - root);
  k = std::sqrt(std::max(0.0, ((eta + 1) * (eta + 1) * r - (eta - 1) * (eta - 1)) / (1 - r)));
}

Material read_gltf_material(const JsonValue& m, const std::function<uint32_t(const JsonValue&)>& texture_of,
                            std::vector<std::string>& notices) {
  Material material;
  material.name = m["name"].text("");
  const auto notice = [&](const char* what) {
    notices.push_back("material " + lanewise::quoted(material.name) + ' ' + what);
  };
  if (has_other_textures(m)) notice("has textures of other things than its colour: not read");
  const JsonValue pbr = m["pbrMetallicRoughness"], texture = pbr["baseColorTexture"];
  const glm::dvec3 color_factor = color(pbr["baseColorFactor"], 1, 1);
  const glm::dvec3 base = (texture.present() ? kTexture : 1) * color_factor;
  const double metallic = share(pbr["metallicFactor"], 1), roughness = share(pbr["roughnessFactor"], 1);
  const double transmission = share(m["extensions"]["KHR_materials_transmission"]["transmissionFactor"], 0);

  read_emission(m, material);
  if (material.kind == Material::Kind::kEmission) return material;
  const bool is_diffuse = transmission < 0.5 && metallic < 0.5;
  if (texture.present() && !is_diffuse) notice("has a texture and is not diffuse: half of its colour stands for it");
  if (transmission >= 0.5) {
    make_glass(m, base, material);
    if (pbr["roughnessFactor"].present()) material.roughness = roughness * roughness;
  } else if (metallic >= 0.5) {
    make_metal(base, roughness * roughness, material);
  } else {
    if (texture.present()) material.texture = texture_of(texture);
    material.reflectance = material.texture == kNoTexture ? base : color_factor;
    const std::string alpha_mode = m["alphaMode"].text("OPAQUE");
    if (alpha_mode != "OPAQUE") notice("is partly transparent: rendered opaque");
  }
  return material;
}

}  // namespace lanewise
