#include "scenes/collada_geometry.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>
namespace lanewise::collada {
namespace {

constexpr uint32_t kUnused = std::numeric_limits<uint32_t>::max();

// The index tuples of one primitive element: `stride` indices a vertex, of which one is the position's.
struct Inputs {
  size_t stride = 0;
  size_t position_offset = 0;
  size_t normal_offset = 0;
  std::optional<Source> normals;

  struct Texcoords {
    uint64_t set;
    size_t offset;
    Source source;
  };
  std::vector<Texcoords> texcoords;
};

// Polygons as runs of vertices in one list of tuples.
struct Outlines {
  std::vector<uint32_t> indices;
  std::vector<uint32_t> sizes;
};

class MeshReader {
 public:
  MeshReader(const Document& document, ArrayCache& arrays, Geometry& geometry, pugi::xml_node mesh)
      : document_(document), arrays_(arrays), geometry_(geometry), vertices_(mesh.child("vertices")) {
    if (!vertices_) document.fail(mesh, "has no <vertices>");
    for (const pugi::xml_node input : vertices_.children("input")) {
      const char* semantic = input.attribute("semantic").value();
      if (std::strcmp(semantic, "POSITION") == 0) positions_ = arrays_.read(document.refer(input, "source", "source"));
      if (std::strcmp(semantic, "NORMAL") == 0)
        vertex_normals_ = arrays_.read(document.refer(input, "source", "source"));
    }
    if (!positions_) document.fail(vertices_, "has no input POSITION");
    if (vertex_normals_ && vertex_normals_->count < positions_->count) {
      document.fail(vertices_, "has fewer normals than positions");
    }
    new_index_.assign(positions_->count, kUnused);

    for (const pugi::xml_node element : mesh.children()) read_primitive(element);
  }

 private:
  void read_primitive(pugi::xml_node element) {
    const char* kind = element.name();
    const auto is = [&](const char* name) { return std::strcmp(kind, name) == 0; };
    if (is("lines") || is("linestrips")) {
      notice("has lines, which are skipped");
    } else if (is("triangles") || is("polylist") || is("polygons") || is("tristrips") || is("trifans")) {
      const Inputs inputs = read_inputs(element);
      const bool strips = is("tristrips");
      const Outlines outlines = is("triangles")  ? read_triangles(element, inputs)
                                : is("polylist") ? read_polylist(element, inputs)
                                                 : read_polygons(element, inputs);
      add_part(element, inputs, outlines, strips);
    }
  }

  Inputs read_inputs(pugi::xml_node element) {
    Inputs inputs;
    bool has_positions = false;
    inputs.normals = vertex_normals_;
    for (const pugi::xml_node input : element.children("input")) {
      const char* semantic = input.attribute("semantic").value();
      const size_t offset = document_.count(input, "offset").value_or(0);
      if (offset >= kMaxStride) document_.fail(input, "an offset of " + std::to_string(offset));
      inputs.stride = std::max(inputs.stride, offset + 1);
      if (std::strcmp(semantic, "VERTEX") == 0) {
        if (document_.refer(input, "source", "vertices") != vertices_) document_.fail(input, "refers to another mesh");
        has_positions = true;
        inputs.position_offset = offset;
        if (vertex_normals_) inputs.normal_offset = offset;
      }
    }
    for (const pugi::xml_node input : element.children("input")) {
      if (std::strcmp(input.attribute("semantic").value(), "NORMAL") != 0) continue;
      inputs.normals = arrays_.read(document_.refer(input, "source", "source"));
      inputs.normal_offset = document_.count(input, "offset").value_or(0);
    }
    if (document_.root().child("library_images")) read_texcoords(element, inputs);
    if (!has_positions) document_.fail(element, "has no input VERTEX");
    return inputs;
  }

  void read_texcoords(pugi::xml_node element, Inputs& inputs) {
    for (const pugi::xml_node input : element.children("input")) {
      if (std::strcmp(input.attribute("semantic").value(), "TEXCOORD") != 0) continue;
      if (inputs.texcoords.size() == kMaxTexcoords) document_.fail(input, "more than 16 sets of texture coordinates");
      inputs.texcoords.push_back({document_.count(input, "set").value_or(0),
                                  document_.count(input, "offset").value_or(0),
                                  arrays_.read(document_.refer(input, "source", "source"), 2)});
    }
  }

  void check_count(pugi::xml_node element, size_t found) const {
    const auto claimed = document_.count(element, "count");
    if (claimed && *claimed != found) {
      document_.fail(element, "claims " + std::to_string(*claimed) + " primitives, has " + std::to_string(found));
    }
  }

  void check_whole(pugi::xml_node p, size_t indices, size_t multiple) const {
    if (indices % multiple != 0) {
      document_.fail(p, std::to_string(indices) + " indices are not a multiple of " + std::to_string(multiple));
    }
  }

  Outlines read_triangles(pugi::xml_node element, const Inputs& inputs) const {
    Outlines outlines;
    const pugi::xml_node p = element.child("p");
    outlines.indices = document_.indices(p);
    check_whole(p, outlines.indices.size(), 3 * inputs.stride);
    outlines.sizes.assign(outlines.indices.size() / inputs.stride / 3, 3);
    check_count(element, outlines.sizes.size());
    return outlines;
  }

  Outlines read_polylist(pugi::xml_node element, const Inputs& inputs) const {
    Outlines outlines;
    const pugi::xml_node p = element.child("p");
    outlines.sizes = document_.indices(element.child("vcount"));
    outlines.indices = document_.indices(p);
    check_count(element, outlines.sizes.size());
    uint64_t vertices = 0;
    for (const uint32_t size : outlines.sizes) vertices += size;
    check_whole(p, outlines.indices.size(), inputs.stride);
    if (const size_t found = outlines.indices.size() / inputs.stride; found != vertices) {
      document_.fail(element,
                     "<vcount> asks for " + std::to_string(vertices) + " vertices, <p> has " + std::to_string(found));
    }
    return outlines;
  }

  // Also strips and fans: a <p> each.
  Outlines read_polygons(pugi::xml_node element, const Inputs& inputs) {
    Outlines outlines;
    for (const pugi::xml_node child : element.children()) {
      const bool holed = std::strcmp(child.name(), "ph") == 0;
      if (!holed && std::strcmp(child.name(), "p") != 0) continue;
      if (holed) notice("has polygons with holes, which are filled");
      const pugi::xml_node p = holed ? child.child("p") : child;
      const std::vector<uint32_t> indices = document_.indices(p);
      check_whole(p, indices.size(), inputs.stride);
      outlines.indices.insert(outlines.indices.end(), indices.begin(), indices.end());
      outlines.sizes.push_back(static_cast<uint32_t>(indices.size() / inputs.stride));
    }
    check_count(element, outlines.sizes.size());
    return outlines;
  }

  void add_part(pugi::xml_node element, const Inputs& inputs, const Outlines& outlines, bool strips) {
    geometry_.parts.emplace_back();
    Part& part = geometry_.parts.back();
    part.element = element;
    part.symbol = element.attribute("material").value();
    for (const Inputs::Texcoords& input : inputs.texcoords) part.texcoords.push_back({input.set, {}});
    used_.clear();

    const uint32_t* tuple = outlines.indices.data();
    for (const uint32_t size : outlines.sizes) {
      if (size < 3) document_.fail(element, "has a polygon of " + std::to_string(size) + " vertices");
      for (uint32_t i = 2; i < size; ++i) {
        // A fan around the first vertex; in a strip every other triangle is turned around.
        const std::array<uint32_t, 3> fan{0, i - 1, i};
        const std::array<uint32_t, 3> strip{i - 2 + i % 2, i - 1 - i % 2, i};
        add_triangle(part, inputs, tuple, strips ? strip : fan);
      }
      tuple += size * inputs.stride;
    }
    for (const uint32_t old : used_) new_index_[old] = kUnused;
  }

  void add_triangle(Part& part, const Inputs& inputs, const uint32_t* tuples, const std::array<uint32_t, 3>& corners) {
    std::array<uint32_t, 3> triangle;
    std::array<glm::dvec3, 3> normals;
    for (int c = 0; c < 3; ++c) {
      const uint32_t* tuple = tuples + corners[c] * inputs.stride;
      const uint32_t position = tuple[inputs.position_offset];
      if (position >= positions_->count) fail_index(part, "vertex", position, positions_->count);
      if (new_index_[position] == kUnused) {
        new_index_[position] = static_cast<uint32_t>(part.positions.size());
        used_.push_back(position);
        part.positions.push_back((*positions_)[position]);
      }
      triangle[c] = new_index_[position];
      if (inputs.normals) {
        const uint32_t normal = tuple[inputs.normal_offset];
        if (normal >= inputs.normals->count) fail_index(part, "normal", normal, inputs.normals->count);
        normals[c] = (*inputs.normals)[normal];
      }
    }
    for (size_t i = 0; i < inputs.texcoords.size(); ++i) {
      const auto& [set, offset, source] = inputs.texcoords[i];
      std::array<glm::dvec2, 3>& at = part.texcoords[i].corners.emplace_back();
      for (size_t c = 0; c < 3; ++c) {
        const uint32_t index = tuples[corners[c] * inputs.stride + offset];
        if (index >= source.count) fail_index(part, "texture coordinate", index, source.count);
        at[c] = glm::dvec2(source[index]);
      }
    }
    part.triangles.push_back(triangle);
    if (inputs.normals) part.normals.push_back(normals);
  }

  [[noreturn]] void fail_index(const Part& part, const char* what, uint32_t index, size_t count) const {
    document_.fail(part.element, std::string(what) + " index " + std::to_string(index) +
                                     " is out of range: there are " + std::to_string(count));
  }

  void notice(const char* what) {
    geometry_.notices.push_back("geometry " + quoted(name_of(geometry_.element)) + ' ' + what);
  }

  static constexpr size_t kMaxStride = 256;
  static constexpr size_t kMaxTexcoords = 16;  // each is read, and kept, for every corner

  const Document& document_;
  ArrayCache& arrays_;
  Geometry& geometry_;
  pugi::xml_node vertices_;
  std::optional<Source> positions_;
  std::optional<Source> vertex_normals_;
  std::vector<uint32_t> new_index_;  // of each of the file's positions in the part at hand
  std::vector<uint32_t> used_;       // those that it has
};

}  // namespace

Geometry read_geometry(const Document& document, ArrayCache& arrays, pugi::xml_node element) {
  Geometry geometry;
  geometry.element = element;
  if (const pugi::xml_node sphere = cgl_technique(element).child("sphere")) {
    const pugi::xml_node radius = sphere.child("radius");
    if (!radius) document.fail(sphere, "has no <radius>");
    geometry.radius = document.number(radius);
    if (!(geometry.radius > 0)) document.fail(radius, "a sphere's radius must be above 0");
  } else if (const pugi::xml_node mesh = element.child("mesh")) {
    MeshReader(document, arrays, geometry, mesh);
  } else {
    geometry.notices.push_back("geometry " + quoted(name_of(element)) + " is neither a mesh nor a sphere: skipped");
  }
  return geometry;
}

}  // namespace lanewise::collada
