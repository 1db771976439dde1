#include "scenes/collada_image.h"

namespace lanewise::collada {
namespace {

pugi::xml_node param(pugi::xml_node effect, const char* sid) {
  for (const pugi::xml_node scope : {effect.child("profile_COMMON"), effect}) {
    if (const pugi::xml_node found = scope.find_child_by_attribute("newparam", "sid", sid)) return found;
  }
  return {};
}

std::string trimmed(const std::string& text) {
  constexpr const char* kSpace = " \t\r\n";
  const size_t begin = text.find_first_not_of(kSpace), end = text.find_last_not_of(kSpace);
  return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

pugi::xml_node image_of(const Document& document, pugi::xml_node effect, pugi::xml_node texture) {
  const char* name = texture.attribute("texture").value();
  const pugi::xml_node sampler = param(effect, name).child("sampler2D");
  if (!sampler) {
    const pugi::xml_node image = document.by_id(name, "image");
    if (!image) document.fail(texture, "refers to " + quoted(name) + ", but no sampler and no <image> is called so");
    return image;
  }
  if (const pugi::xml_node instance = sampler.child("instance_image")) return document.refer(instance, "url", "image");
  const pugi::xml_node source = sampler.child("source");
  const std::string surface = trimmed(source.child_value());
  const pugi::xml_node from = param(effect, surface.c_str()).child("surface").child("init_from");
  if (!from) document.fail(sampler, "refers to " + quoted(surface) + ", but no surface <newparam> has that sid");
  const std::string id = trimmed(from.child_value());
  const pugi::xml_node image = document.by_id(id, "image");
  if (!image) document.fail(from, "refers to " + quoted(id) + ", but no <image> has that id");
  return image;
}

}  // namespace

std::string image_file(const Document& document, pugi::xml_node effect, pugi::xml_node texture) {
  const pugi::xml_node image = image_of(document, effect, texture);
  const pugi::xml_node from = image.child("init_from"), reference = from.child("ref");
  const std::string file = trimmed((reference ? reference : from).child_value());
  if (file.empty()) document.fail(image, "names no file in an <init_from>");
  return file;
}

}  // namespace lanewise::collada
