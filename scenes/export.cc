#include "scenes/export.h"

#include <array>
#include <charconv>
#include <cstring>
#include <map>

namespace lanewise {
namespace {

using Vertex = std::array<float, 6>;  // a position, a normal

void append(std::string& bytes, const void* data, size_t size) { bytes.append(static_cast<const char*>(data), size); }

Vertex vertex(const Mesh& mesh, size_t triangle, int corner, bool normals) {
  const glm::vec3 p(mesh.positions[mesh.triangles[triangle][corner]]);
  const glm::vec3 n(normals ? mesh.normals[triangle][corner] : glm::dvec3(0.0));
  return {p.x, p.y, p.z, n.x, n.y, n.z};
}

}  // namespace

std::string ply_file(const Mesh& mesh, bool normals) {
  normals &= !mesh.normals.empty();
  const size_t floats = normals ? 6 : 3;
  std::string vertices, faces;
  std::map<Vertex, uint32_t> known;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    faces += '\3';
    for (int c = 0; c < 3; ++c) {
      const Vertex v = vertex(mesh, t, c, normals);
      const auto [at, is_new] = known.try_emplace(v, static_cast<uint32_t>(known.size()));
      if (is_new) append(vertices, v.data(), floats * sizeof(float));
      append(faces, &at->second, sizeof(uint32_t));
    }
  }
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(known.size()) + "\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) {
    if (normals || name[0] != 'n') text += std::string("property float ") + name + "\n";
  }
  text += "element face " + std::to_string(mesh.triangles.size()) +
          "\nproperty list uchar int vertex_indices\nend_header\n";
  return text + vertices + faces;
}

std::string mesh_path(const std::string& folder, size_t mesh) { return folder + "/" + std::to_string(mesh) + ".ply"; }

std::string exact(double value) {
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value);
  return {text, end};
}

std::string exact(const glm::dvec3& value) { return exact(value.x) + ' ' + exact(value.y) + ' ' + exact(value.z); }

}  // namespace lanewise
