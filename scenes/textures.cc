#include "scenes/textures.h"

#include <algorithm>

#include "core/file.h"
#include "core/image_stb.h"
#include "core/types.h"
#include "scenes/own_file.h"
#include "scenes/quoted.h"

namespace lanewise {
namespace {

constexpr uint64_t kMostTexels = uint64_t{1} << 27;  // of one: 16384 x 8192
// Of all, so that many small files that hold large pictures, as flat ones do, are refused.
constexpr uint64_t kMostTexelsInAll = uint64_t{1} << 27, kMoreTexelsPerByte = 64;

}  // namespace

uint32_t Textures::file(const std::string& name) {
  const auto [place, is_new] = known_.try_emplace(name, kNoTexture);
  if (!is_new) return place->second;
  const std::string path = find_own_file(scene_.path, name);
  if (path.empty()) {
    scene_.notices.push_back("texture " + quoted(name) + " is no file in the scene's folder: not read");
    return kNoTexture;
  }
  try {
    return add(decode(read_file(path, kMaxStbBytes)), name);
  } catch (const Error& e) {
    throw Error(path + ": cannot read: " + e.what());
  }
}

uint32_t Textures::embedded(const std::string& name, const std::string& bytes) {
  const auto [place, is_new] = known_.try_emplace(name, kNoTexture);
  if (!is_new) return place->second;
  try {
    return add(decode(bytes), name);
  } catch (const Error& e) {
    throw Error(scene_.path + ": " + name + ": cannot read: " + e.what());
  }
}

Texture Textures::decode(const std::string& bytes) {
  bytes_ += bytes.size();
  const uint64_t bearable = kMostTexelsInAll + kMoreTexelsPerByte * bytes_;
  Texture texture = decode_texture(bytes, std::min(kMostTexels, bearable - texels_));
  texels_ += texture.texels.size();
  return texture;
}

uint32_t Textures::add(Texture texture, const std::string& name) {
  texture.name = name;
  scene_.textures.push_back(std::move(texture));
  return known_[name] = static_cast<uint32_t>(scene_.textures.size() - 1);
}

}  // namespace lanewise
