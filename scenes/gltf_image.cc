#include "scenes/gltf_image.h"

#include <algorithm>
#include <boost/archive/iterators/binary_from_base64.hpp>
#include <boost/archive/iterators/transform_width.hpp>

#include "core/file.h"
#include "core/types.h"
#include "scenes/own_file.h"
#include "scenes/quoted.h"

namespace lanewise {
namespace {

constexpr uint64_t kMaxFileBytes = uint64_t{4} << 30;

// The bytes of "data:image/png;base64,iVBOR...".
std::string decode_uri(const JsonValue& uri, const std::string& text) {
  using Bytes = boost::archive::iterators::transform_width<
      boost::archive::iterators::binary_from_base64<std::string_view::const_iterator>, 8, 6>;
  const size_t comma = text.find(',');
  if (comma == std::string::npos || !std::string_view(text).substr(0, comma).ends_with(";base64")) {
    uri.fail("is a data: URI without ;base64,");
  }
  std::string_view digits = std::string_view(text).substr(comma + 1);
  while (digits.ends_with('=')) digits.remove_suffix(1);
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  if (digits.find_first_not_of(kDigits) != std::string_view::npos) uri.fail("is a data: URI that is not base64");
  digits.remove_suffix(digits.size() % 4 == 1 ? 1 : 0);  // six bits alone make no byte
  std::string bytes;
  bytes.reserve(digits.size() / 4 * 3 + 2);
  Bytes next(digits.begin());
  for (size_t i = 0; i < digits.size() * 3 / 4; ++i) bytes += static_cast<char>(*next++);
  return bytes;
}

bool is_data(const std::string& uri) { return uri.starts_with("data:"); }

}  // namespace

uint32_t GltfImages::texture(const JsonValue& info, std::vector<std::string>& notices) {
  const JsonValue textures = document_.root()["textures"], images = document_.root()["images"];
  const JsonValue texture = textures.at(info["index"].index(textures));
  if (info["extensions"]["KHR_texture_transform"].present()) {
    notices.push_back("a texture's transform (KHR_texture_transform) is not applied");
  }
  const JsonValue samplers = document_.root()["samplers"];
  if (texture["sampler"].present()) {
    const JsonValue sampler = samplers.at(texture["sampler"].index(samplers));
    constexpr uint64_t kRepeat = 10497;
    if (sampler["wrapS"].count(kRepeat) != kRepeat || sampler["wrapT"].count(kRepeat) != kRepeat) {
      notices.push_back("a texture is not to be repeated beyond its edges: it is");
    }
  }
  if (!texture["source"].present()) {
    notices.push_back("a texture is in a format of an extension: not read");
    return kNoTexture;
  }
  return image(texture["source"].index(images), notices);
}

uint32_t GltfImages::image(size_t index, std::vector<std::string>& notices) {
  const JsonValue image = document_.root()["images"].at(index);
  const std::string name = "image " + std::to_string(index), uri = image["uri"].text("");
  if (const std::string kind = image["mimeType"].text("image/png"); kind != "image/png" && kind != "image/jpeg") {
    notices.push_back(name + " is of type " + lanewise::quoted(kind) + ": not read");
    return kNoTexture;
  }
  if (is_data(uri)) return textures_.embedded(name, decode_uri(image["uri"], uri));
  if (image["uri"].present()) return textures_.file(uri);
  const JsonValue views = document_.root()["bufferViews"], buffers = document_.root()["buffers"];
  const JsonValue view = views.at(image["bufferView"].index(views));
  const std::string_view bytes = buffer(buffers, view["buffer"].index(buffers));
  const uint64_t begin = view["byteOffset"].count(0), length = view["byteLength"].count(0);
  if (begin > bytes.size() || length > bytes.size() - begin) view.fail("reaches beyond its buffer");
  return textures_.embedded(name, std::string(bytes.substr(begin, length)));
}

std::string_view GltfImages::buffer(const JsonValue& list, size_t index) {
  const JsonValue uri = list.at(index)["uri"];
  if (!uri.present()) return document_.binary_chunk();
  const auto [place, is_new] = buffers_.try_emplace(index);
  if (!is_new) return place->second;
  const std::string text = uri.text("");
  if (is_data(text)) return place->second = decode_uri(uri, text);
  const std::string path = find_own_file(document_.path(), text);
  if (path.empty()) uri.fail("is no file in the scene's folder");
  try {
    return place->second = read_file(path, kMaxFileBytes);
  } catch (const Error& e) {
    throw Error(path + ": cannot read: " + e.what());
  }
}

}  // namespace lanewise
