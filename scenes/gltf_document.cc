#include "scenes/gltf_document.h"

#include <charconv>
#include <cstring>

#include "core/types.h"
#include "scenes/gltf_check.h"

namespace lanewise {
namespace {

using nlohmann::json;

constexpr std::string_view kMagic = "glTF";
constexpr uint32_t kVersion = 2;
constexpr uint32_t kJsonChunk = 0x4E4F534A;
constexpr uint32_t kBinaryChunk = 0x004E4942;
constexpr size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
constexpr int kMaxNesting = 1000;  // of JSON: the next reader of it is recursive

uint32_t word_at(std::string_view bytes, size_t offset) {  // little-endian, as the machine is
  uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, sizeof word);
  return word;
}

void append_word(std::string& bytes, size_t value) {
  const auto word = static_cast<uint32_t>(value);
  bytes.append(reinterpret_cast<const char*>(&word), sizeof word);
}

// The members of an object that are named; {} for what is none.
json kept(const json& from, std::initializer_list<const char*> members) {
  json to = json::object();
  for (const char* member : members) {
    if (from.is_object() && from.contains(member)) to[member] = from[member];
  }
  return to;
}

// Of each element of a list.
template <class F>
void copy_list(const json& from, json& to, const char* list, F copy) {
  if (!from.contains(list)) return;
  for (size_t i = 0; i < from[list].size(); ++i) to[list].push_back(copy(from[list][i], std::to_string(i)));
}

// The set of texture coordinates that the primitive's material wants for its base colour; null: none.
json texcoords_of(const JsonValue& root, const JsonValue& primitive) {
  constexpr uint64_t kFloat = 5126;  // what Assimp takes any other for
  const JsonValue materials = root["materials"], attributes = primitive["attributes"];
  if (!primitive["material"].present()) return {};
  const JsonValue material = materials.at(primitive["material"].index(materials));
  const JsonValue base = material["pbrMetallicRoughness"]["baseColorTexture"];
  const std::string set = "TEXCOORD_" + std::to_string(base["texCoord"].count(0));
  if (!base.present() || !attributes[set.c_str()].present()) return {};
  const JsonValue accessor = root["accessors"].at(attributes[set.c_str()].index(root["accessors"]));
  return accessor["componentType"].count(0) == kFloat ? attributes[set.c_str()].json() : json();
}

json kept_primitive(const JsonValue& root, const JsonValue& from) {
  const json& primitive = from.json();
  json to = kept(primitive, {"indices", "material", "mode"});
  to["attributes"] = kept(primitive["attributes"], {"POSITION", "NORMAL"});
  if (const json texcoords = texcoords_of(root, from); !texcoords.is_null()) to["attributes"]["TEXCOORD_0"] = texcoords;
  if (primitive.contains("extensions"))
    to["extensions"] = kept(primitive["extensions"], {"KHR_draco_mesh_compression"});
  return to;
}

}  // namespace

GltfDocument::GltfDocument(const std::string& path, const std::string& text) : path_(path), text_(text) {
  binary_ = text_.starts_with(kMagic);
  if (binary_) {
    read_chunks();
  } else {
    parse(text_);
  }
  check_gltf(root());
}

void GltfDocument::read_chunks() {
  const std::string_view all = text_;
  if (all.size() < kHeaderBytes + kChunkHeaderBytes) throw Error(path_ + ": is truncated");
  if (const uint32_t version = word_at(all, 4); version != kVersion) {
    throw Error(path_ + ": is glTF " + std::to_string(version) + ": only glTF 2 is read");
  }
  if (word_at(all, 8) > all.size()) throw Error(path_ + ": is truncated");
  const size_t length = word_at(all, kHeaderBytes), begin = kHeaderBytes + kChunkHeaderBytes;
  if (word_at(all, kHeaderBytes + 4) != kJsonChunk) throw Error(path_ + ": does not begin with a chunk of JSON");
  if (length > all.size() - begin) throw Error(path_ + ": is truncated");
  parse(all.substr(begin, length));
  chunks_ = all.substr(begin + length);
}

void GltfDocument::parse(std::string_view text) {
  bool deep = false;
  const auto limit = [&deep](int depth, json::parse_event_t, json&) {
    deep |= depth > kMaxNesting;
    return !deep;  // what is deeper is left out as it is read
  };
  try {
    json_ = json::parse(text, limit);
  } catch (const json::parse_error& e) {
    throw Error(path_ + ": not JSON: byte " + std::to_string(e.byte));
  } catch (const json::out_of_range&) {
    throw Error(path_ + ": a number is beyond the range of a double");
  }
  if (deep) throw Error(path_ + ": JSON that is nested more than 1000 deep");
  if (!json_.is_object()) throw Error(path_ + ": the JSON is not an object");
}

std::string GltfDocument::geometry() const {
  json to = kept(json_, {"asset", "scene", "scenes", "accessors", "bufferViews", "buffers"});
  to["asset"] = {{"version", "2.0"}};
  if (json_.contains("extensionsRequired")) to["extensionsUsed"] = json_["extensionsRequired"];
  copy_list(json_, to, "nodes", [](const json& node, const std::string& index) {
    json copy = kept(node, {"children", "mesh", "matrix", "translation", "rotation", "scale"});
    copy["name"] = "node " + index;
    return copy;
  });
  for (const JsonValue& mesh : root()["meshes"].elements()) {
    json copy;
    for (const JsonValue& primitive : mesh["primitives"].elements()) {
      copy["primitives"].push_back(kept_primitive(root(), primitive));
    }
    to["meshes"].push_back(copy);
  }
  copy_list(json_, to, "materials", [](const json&, const std::string& index) {
    return json{{"name", "material " + index}};
  });
  std::string text = to.dump(-1, ' ', true, json::error_handler_t::replace);
  if (!binary_) return text;
  text.append((4 - text.size() % 4) % 4, ' ');
  std::string file(kMagic);
  append_word(file, kVersion);
  append_word(file, kHeaderBytes + kChunkHeaderBytes + text.size() + chunks_.size());
  append_word(file, text.size());
  append_word(file, kJsonChunk);
  return file.append(text).append(chunks_);
}

std::string_view GltfDocument::binary_chunk() const {
  if (chunks_.size() < kChunkHeaderBytes || word_at(chunks_, 4) != kBinaryChunk) return {};
  return chunks_.substr(kChunkHeaderBytes, word_at(chunks_, 0));
}

std::vector<std::string> GltfDocument::notices() const {
  std::vector<std::string> notices;
  if (root()["animations"].present()) notices.push_back("the file has animations: rendered as it stands without them");
  if (root()["skins"].present()) notices.push_back("the file has skins: rendered as the meshes stand without them");
  const JsonValue lights = root()["extensions"]["KHR_lights_punctual"]["lights"];
  if (lights.present()) notices.push_back("the file's punctual lights have no area: skipped");
  for (const JsonValue& mesh : root()["meshes"].elements()) {
    for (const JsonValue& primitive : mesh["primitives"].elements()) {
      if (primitive["targets"].present()) {
        notices.push_back("the file has morph targets: rendered as the meshes stand without them");
        return notices;
      }
    }
  }
  return notices;
}

std::optional<size_t> GltfDocument::index_of(const std::string& name, std::string_view prefix) {
  size_t index = 0;
  if (!name.starts_with(prefix)) return {};
  const char *const begin = name.data() + prefix.size(), *const end = name.data() + name.size();
  const auto [rest, error] = std::from_chars(begin, end, index);
  if (error != std::errc() || rest != end) return {};
  return index;
}

}  // namespace lanewise
