#include "scenes/collada_material.h"

#include <cstring>
#include <string_view>

#include "scenes/collada_image.h"

namespace lanewise::collada {
namespace {

// Stands in for what is not there to be read.
constexpr double kGrey = 0.5;

// Squares and products of values up to this stay finite in float.
constexpr double kLargest = 1e15;

glm::dvec3 read_color(const Document& document, pugi::xml_node node, double lo, double hi) {
  const glm::dvec3 color = document.color(node);
  for (int c = 0; c < 3; ++c) {
    if (!(color[c] >= lo && color[c] <= hi)) {
      document.fail(node, hi == 1 ? "values must be between 0 and 1" : "a value is negative or too large");
    }
  }
  return color;
}

glm::dvec3 read_albedo(const Document& document, pugi::xml_node node) { return read_color(document, node, 0, 1); }

pugi::xml_node required(const Document& document, pugi::xml_node parent, const char* name) {
  const pugi::xml_node child = parent.child(name);
  if (!child) document.fail(parent, "has no <" + std::string(name) + ">");
  return child;
}

double read_positive(const Document& document, pugi::xml_node parent, const char* name, double hi) {
  const pugi::xml_node node = required(document, parent, name);
  const double value = document.number(node);
  if (!(static_cast<float>(value) > 0 && value <= hi)) {
    document.fail(node, "must be above 0 and at most " + std::to_string(static_cast<int>(hi)));
  }
  return value;
}

void read_tint(const Document& document, pugi::xml_node parent, const char* name, glm::dvec3& tint) {
  tint = glm::dvec3(1.0);
  if (const pugi::xml_node node = parent.child(name)) tint = read_albedo(document, node);
}

void read_glass(const Document& document, pugi::xml_node node, Material& material) {
  material.kind = Material::Kind::kGlass;
  read_tint(document, node, "reflectance", material.reflectance);
  read_tint(document, node, "transmittance", material.transmittance);
  material.ior = read_positive(document, node, "ior", 100);
  if (const pugi::xml_node roughness = node.child("roughness")) {
    material.roughness = document.number(roughness);
    if (!(material.roughness >= 0 && material.roughness <= 1000)) {
      document.fail(roughness, "must be between 0 and 1000");
    }
  }
}

void read_microfacet(const Document& document, pugi::xml_node node, Material& material) {
  material.kind = Material::Kind::kMicrofacet;
  material.alpha = read_positive(document, node, "alpha", 1000);
  const pugi::xml_node eta = required(document, node, "eta");
  material.eta = read_color(document, eta, 0, 1000);
  if (glm::any(glm::equal(glm::vec3(material.eta), glm::vec3(0.0f)))) document.fail(eta, "values must be above 0");
  material.k = read_color(document, required(document, node, "k"), 0, 1000);
}

// node: the child of a CGL technique.
void read_cgl(const Document& document, pugi::xml_node node, Material& material) {
  const std::string_view kind = node.name();
  if (kind == "mirror") {
    material.kind = Material::Kind::kMirror;
    read_tint(document, node, "reflectance", material.reflectance);
  } else if (kind == "glass" || kind == "refraction") {
    read_glass(document, node, material);
  } else if (kind == "microfacet") {
    read_microfacet(document, node, material);
  } else if (kind == "emission") {
    material.kind = Material::Kind::kEmission;
    material.radiance = read_radiance(document, required(document, node, "radiance"));
  } else if (kind == "diffuse" || kind == "lambertian") {
    const char* name = node.child("albedo") ? "albedo" : "reflectance";
    material.reflectance = read_albedo(document, required(document, node, name));
  } else {
    document.fail(node, "unknown CGL material; known are mirror, glass, refraction, microfacet, emission, diffuse");
  }
}

pugi::xml_node first_element(pugi::xml_node parent) {
  return parent.find_child([](pugi::xml_node child) { return child.type() == pugi::node_element; });
}

// Exporters put the extra at any of the effect's three levels.
pugi::xml_node cgl_material(pugi::xml_node effect) {
  const pugi::xml_node profile = effect.child("profile_COMMON");
  for (const pugi::xml_node level : {effect, profile, profile.child("technique")}) {
    if (const pugi::xml_node material = first_element(cgl_technique(level))) return material;
  }
  return {};
}

// The <color> of a <diffuse> or <emission>, or the value of the parameter that it names; null for a texture or nothing.
pugi::xml_node color_element(const Document& document, pugi::xml_node effect, pugi::xml_node slot) {
  if (const pugi::xml_node color = slot.child("color")) return color;
  const pugi::xml_node reference = slot.child("param");
  if (!reference) return {};
  const char* name = reference.attribute("ref").value();
  for (const pugi::xml_node scope : {effect.child("profile_COMMON"), effect}) {
    const pugi::xml_node param = scope.find_child_by_attribute("newparam", "sid", name);
    for (const char* type : {"float3", "float4"}) {
      if (const pugi::xml_node value = param.child(type)) return value;
    }
  }
  document.fail(reference, "refers to " + quoted(name) + ", but no colour <newparam> has that sid");
}

void read_texture(const Document& document, pugi::xml_node effect, pugi::xml_node element, Textures& textures,
                  Material& material, std::vector<std::string>& notices) {
  material.texture = textures.file(image_file(document, effect, element));
  material.reflectance = glm::dvec3(material.texture == kNoTexture ? kGrey : 1);
  if (material.texture == kNoTexture) {
    notices.push_back("material " + quoted(material.name) + " is rendered as diffuse grey 0.5: its texture is missing");
  }
}

void read_common(const Document& document, pugi::xml_node effect, Textures& textures, Material& material,
                 std::string& texcoords, std::vector<std::string>& notices) {
  material.reflectance = glm::dvec3(kGrey);
  pugi::xml_node shader;
  for (const char* name : {"phong", "lambert", "blinn", "constant"}) {
    if (!shader) shader = effect.child("profile_COMMON").child("technique").child(name);
  }
  if (!shader) {
    notices.push_back("material " + quoted(material.name) + " has no common profile: rendered as diffuse grey 0.5");
    return;
  }
  if (const pugi::xml_node emission = color_element(document, effect, shader.child("emission"))) {
    const glm::dvec3 radiance = read_radiance(document, emission);
    if (radiance != glm::dvec3(0.0)) {
      material.kind = Material::Kind::kEmission;
      material.radiance = radiance;
      return;
    }
  }
  const pugi::xml_node diffuse = shader.child("diffuse");
  if (const pugi::xml_node color = color_element(document, effect, diffuse)) {
    material.reflectance = read_albedo(document, color);
  } else if (const pugi::xml_node texture = diffuse.child("texture")) {
    read_texture(document, effect, texture, textures, material, notices);
    texcoords = texture.attribute("texcoord").value();
  } else {
    material.reflectance = glm::dvec3(0.0);
  }
}

}  // namespace

glm::dvec3 read_radiance(const Document& document, pugi::xml_node node) {
  return read_color(document, node, 0, kLargest);
}

Material read_material(const Document& document, pugi::xml_node element, Textures& textures, std::string& texcoords,
                       std::vector<std::string>& notices) {
  Material material;
  material.name = name_of(element);
  const pugi::xml_node instance = element.child("instance_effect");
  if (!instance) document.fail(element, "has no <instance_effect>");
  const pugi::xml_node effect = document.refer(instance, "url", "effect");
  if (const pugi::xml_node cgl = cgl_material(effect)) {
    read_cgl(document, cgl, material);
  } else {
    read_common(document, effect, textures, material, texcoords, notices);
  }
  return material;
}

}  // namespace lanewise::collada
