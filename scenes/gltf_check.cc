#include "scenes/gltf_check.h"

#include <algorithm>
#include <string_view>

#include "scenes/quoted.h"

namespace lanewise {
namespace {

constexpr int kMaxDepth = 1000;
constexpr uint64_t kMaxMeshes = 1'000'000;
constexpr uint64_t kMaxBytes = uint64_t{1} << 33;     // of a buffer: products of two such numbers stay exact
constexpr uint64_t kMaxCount = uint64_t{1} << 28;     // of an accessor's elements
constexpr uint64_t kMaxShared = uint64_t{1} << 22;    // of vertices and indices beyond 4 for every byte of the buffers
constexpr uint64_t kMaxUnstored = uint64_t{1} << 20;  // of those that no buffer holds, and a few bytes ask for

constexpr uint64_t kByte = 5121, kShort = 5123, kInt = 5125, kFloat = 5126;

class Checker {
 public:
  explicit Checker(const JsonValue& root)
      : root_(root), accessors_(root["accessors"]), views_(root["bufferViews"]), buffers_(root["buffers"]) {}

  void check() {
    check_version();
    for (const JsonValue& buffer : buffers_.elements()) bytes_ += bounded(buffer["byteLength"], kMaxBytes);
    for (const JsonValue& view : views_.elements()) check_view(view);
    for (const JsonValue& accessor : accessors_.elements()) check_accessor(accessor);
    for (const JsonValue& mesh : root_["meshes"].elements()) check_mesh(mesh);
    check_nodes();
  }

 private:
  void check_version() const {
    const std::string version = root_["asset"]["version"].text("");
    if (!version.starts_with("2."))
      root_["asset"]["version"].fail("is " + lanewise::quoted(version) + ": only glTF 2 is read");
    for (const JsonValue& extension : root_["extensionsRequired"].elements()) {
      const std::string name = extension.text("");
      if (!name.starts_with("KHR_materials_") && name != "KHR_texture_transform" && name != "KHR_lights_punctual" &&
          name != "KHR_draco_mesh_compression") {
        extension.fail("is " + lanewise::quoted(name) + ": not supported");
      }
    }
  }

  static uint64_t bounded(const JsonValue& value, uint64_t most) {
    const uint64_t found = value.count(0);
    if (found > most) value.fail("is too large");
    return found;
  }

  void check_view(const JsonValue& view) const {
    const JsonValue buffer = buffers_.at(view["buffer"].index(buffers_));
    const uint64_t end = bounded(view["byteOffset"], kMaxBytes) + bounded(view["byteLength"], kMaxBytes);
    if (end > buffer["byteLength"].count(0)) view.fail("reaches beyond its buffer");
    bounded(view["byteStride"], 252);
  }

  static uint64_t component_bytes(const JsonValue& type) {
    switch (type.count(0)) {
      case 5120:
      case kByte:
        return 1;
      case 5122:
      case kShort:
        return 2;
      case kInt:
      case kFloat:
        return 4;
      default:
        type.fail("is no component type");
    }
  }

  static uint64_t components(const JsonValue& type) {
    constexpr std::pair<std::string_view, uint64_t> kTypes[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                                                                {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
    const std::string name = type.text("");
    for (const auto& [known, count] : kTypes) {
      if (name == known) return count;
    }
    type.fail("is no accessor type");
  }

  // `count` elements of `bytes` each, at the offset in the view.
  void check_reach(const JsonValue& what, uint64_t count, uint64_t bytes) const {
    const JsonValue view = views_.at(what["bufferView"].index(views_));
    const uint64_t stride = std::max(view["byteStride"].count(0), bytes);
    const uint64_t offset = bounded(what["byteOffset"], kMaxBytes);
    if (count > 0 && offset + (count - 1) * stride + bytes > view["byteLength"].count(0)) {
      what.fail("reaches beyond its buffer view");
    }
  }

  void check_accessor(const JsonValue& accessor) const {
    const uint64_t bytes = component_bytes(accessor["componentType"]) * components(accessor["type"]);
    const uint64_t count = bounded(accessor["count"], kMaxCount);
    if (accessor["bufferView"].present()) {
      check_reach(accessor, count, bytes);
    } else if (count > kMaxUnstored) {
      accessor.fail("has many elements that no buffer holds");
    }
    const JsonValue sparse = accessor["sparse"];
    if (!sparse.present()) return;
    const uint64_t changed = sparse["count"].count(0);
    if (changed > count) sparse["count"].fail("is more than the accessor's count");
    check_reach(sparse["indices"], changed, component_bytes(sparse["indices"]["componentType"]));
    check_reach(sparse["values"], changed, bytes);
  }

  JsonValue accessor(const JsonValue& reference, const char* type, std::initializer_list<uint64_t> kinds) const {
    const JsonValue found = accessors_.at(reference.index(accessors_));
    if (found["type"].text("") != type) reference.fail("refers to an accessor whose type is not " + std::string(type));
    const uint64_t kind = found["componentType"].count(0);
    if (std::ranges::find(kinds, kind) == kinds.end()) {
      reference.fail("refers to an accessor of component type " + std::to_string(kind));
    }
    return found;
  }

  void check_texcoords(const JsonValue& attributes, uint64_t count) const {
    for (const auto& [name, value] : attributes.json().items()) {
      if (!name.starts_with("TEXCOORD_")) continue;
      const JsonValue reference = attributes[name.c_str()];
      if (accessor(reference, "VEC2", {kByte, kShort, kFloat})["count"].count(0) != count) {
        reference.fail("has another length than POSITION");
      }
    }
  }

  void check_mesh(const JsonValue& mesh) {
    const std::vector<JsonValue> primitives = mesh["primitives"].elements();
    if (primitives.empty()) mesh.fail("has no primitives");
    for (const JsonValue& primitive : primitives) {
      const JsonValue attributes = primitive["attributes"];
      if (!attributes["POSITION"].present()) attributes.fail("has no POSITION");
      const JsonValue positions = accessor(attributes["POSITION"], "VEC3", {kFloat});
      corners_ += positions["count"].count(0);
      if (attributes["NORMAL"].present() &&
          accessor(attributes["NORMAL"], "VEC3", {kFloat})["count"].count(0) != positions["count"].count(0)) {
        attributes["NORMAL"].fail("has another length than POSITION");
      }
      check_texcoords(attributes, positions["count"].count(0));
      if (primitive["indices"].present()) {
        corners_ += accessor(primitive["indices"], "SCALAR", {kByte, kShort, kInt})["count"].count(0);
      }
      if (corners_ > kMaxCount) mesh.fail("brings the file to more than 2^28 vertices and indices");
      if (corners_ > kMaxShared + 4 * bytes_)
        mesh.fail("brings the file to many more vertices and indices than it has bytes");
      if (primitive["material"].present()) primitive["material"].index(root_["materials"]);
      if (primitive["mode"].count(4) > 6) primitive["mode"].fail("is none from 0 to 6");
    }
  }

  void check_nodes() {
    nodes_ = root_["nodes"].elements();
    reached_.assign(nodes_.size(), false);
    for (const JsonValue& node : nodes_) {
      if (node["mesh"].present()) node["mesh"].index(root_["meshes"]);
      if (node["camera"].present()) node["camera"].index(root_["cameras"]);
      check_numbers(node["matrix"], 16);
      check_numbers(node["translation"], 3);
      check_numbers(node["rotation"], 4);
      check_numbers(node["scale"], 3);
    }
    const std::vector<JsonValue> scenes = root_["scenes"].elements();
    if (scenes.empty()) root_.fail("has no scenes");
    const JsonValue chosen = root_["scene"].present() ? scenes[root_["scene"].index(root_["scenes"])] : scenes[0];
    visit(chosen["nodes"], 1);
  }

  static void check_numbers(const JsonValue& list, size_t size) {
    if (!list.present()) return;
    const std::vector<JsonValue> values = list.elements();
    if (values.size() != size) list.fail("has not " + std::to_string(size) + " numbers");
    for (const JsonValue& value : values) value.number(0);
  }

  void count_meshes(const JsonValue& mesh) {
    if (!mesh.present()) return;
    meshes_ += root_["meshes"].at(mesh.index(root_["meshes"]))["primitives"].json().size();
    if (meshes_ > kMaxMeshes) mesh.fail("brings the file to more than 1 million meshes, instances counted");
  }

  void visit(const JsonValue& children, int depth) {
    if (depth > kMaxDepth) children.fail("are nested more than 1000 deep");
    for (const JsonValue& child : children.elements()) {
      const size_t index = child.index(root_["nodes"]);
      if (reached_[index]) child.fail("is a node that has a parent already: nodes must be a tree");
      reached_[index] = true;
      count_meshes(nodes_[index]["mesh"]);
      visit(nodes_[index]["children"], depth + 1);
    }
  }

  JsonValue root_, accessors_, views_, buffers_;
  std::vector<JsonValue> nodes_;
  std::vector<bool> reached_;
  uint64_t bytes_ = 0;  // of all buffers, as they claim
  uint64_t corners_ = 0, meshes_ = 0;
};

}  // namespace

void check_gltf(const JsonValue& root) { Checker(root).check(); }

}  // namespace lanewise
