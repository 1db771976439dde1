#include "scenes/collada_size.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <unordered_map>
#include <unordered_set>

namespace lanewise::collada {
namespace {

constexpr uint32_t kMaxDepth = 1000;
constexpr uint64_t kMaxNodes = 1'000'000;
constexpr uint64_t kMaxTriangles = uint64_t{1} << 26;
constexpr uint64_t kMaxCopies = uint64_t{1} << 23;  // of triangles: a small file may ask for no more than that

// Of a node with all below it.
struct Size {
  uint64_t nodes = 1;
  uint64_t triangles = 0;
  uint32_t height = 1;
  bool open = true;  // being measured: meeting it again means a cycle
};

class Measure {
 public:
  Measure(const Document& document, Library& library) : document_(document), library_(library) {}

  // Each node is measured once and remembered, so shared subtrees cost nothing. depth: levels above the node.
  const Size& measure(pugi::xml_node node, uint32_t depth) {
    const auto [place, is_new] = sizes_.try_emplace(node.hash_value());
    Size& size = place->second;
    if (!is_new) {
      if (size.open) document_.fail(node, "the node contains itself");
      check_depth(node, depth + size.height);
      return size;
    }
    check_depth(node, depth + 1);
    for (const pugi::xml_node child : node.children()) {
      if (std::strcmp(child.name(), "node") == 0) {
        add(size, measure(child, depth + 1));
      } else if (std::strcmp(child.name(), "instance_node") == 0) {
        add(size, measure(document_.refer(child, "url", "node"), depth + 1));
      } else if (std::strcmp(child.name(), "instance_geometry") == 0) {
        add_geometry(size, library_.geometry(child));
      }
      if (size.nodes > kMaxNodes) document_.fail(node, "holds more than 1 million nodes and meshes, instances counted");
      if (size.triangles > kMaxTriangles) document_.fail(node, "holds more than 2^26 triangles, instances counted");
      if (size.triangles > kMaxCopies + own_triangles_) {
        document_.fail(node, "holds more than 2^23 triangles beyond the file's own, by instances");
      }
    }
    size.open = false;
    return size;
  }

 private:
  void add_geometry(Size& size, const Geometry& geometry) {
    uint64_t triangles = 0;
    for (const Part& part : geometry.parts) triangles += part.triangles.size();
    if (counted_.insert(&geometry).second) own_triangles_ += triangles;
    size.triangles += triangles;
    size.nodes += 1 + geometry.parts.size();
  }

  static void add(Size& size, const Size& child) {
    size.nodes += child.nodes;
    size.triangles += child.triangles;
    size.height = std::max(size.height, child.height + 1);
  }

  void check_depth(pugi::xml_node node, uint32_t depth) const {
    if (depth > kMaxDepth) document_.fail(node, "nodes are nested more than 1000 deep");
  }

  const Document& document_;
  Library& library_;
  std::unordered_set<const Geometry*> counted_;
  uint64_t own_triangles_ = 0;              // of those
  std::unordered_map<size_t, Size> sizes_;  // by hash_value; references to its values survive insertions
};

}  // namespace

void check_size(const Document& document, Library& library, pugi::xml_node root) {
  Measure(document, library).measure(root, 0);
}

}  // namespace lanewise::collada
