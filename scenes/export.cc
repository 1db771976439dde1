#include "scenes/export.h"

#include <array>
#include <charconv>
#include <cstring>
#include <map>

namespace lanewise {
namespace {

using Vertex = std::array<float, 8>;  // a position, a normal, a place in the texture

void append(std::string& bytes, const void* data, size_t size) { bytes.append(static_cast<const char*>(data), size); }

Vertex vertex(const Mesh& mesh, size_t triangle, int corner, bool normals, bool v_down) {
  const glm::vec3 p(mesh.positions[mesh.triangles[triangle][corner]]);
  const glm::vec3 n(normals ? mesh.normals[triangle][corner] : glm::dvec3(0.0));
  const glm::dvec2 at = mesh.texcoords.empty() ? glm::dvec2(0.0) : mesh.texcoords[triangle][corner];
  return {p.x, p.y, p.z, n.x, n.y, n.z, static_cast<float>(at.x), static_cast<float>(v_down ? 1 - at.y : at.y)};
}

}  // namespace

std::string ply_file(const Mesh& mesh, bool normals, bool v_down) {
  normals &= !mesh.normals.empty();
  const bool texcoords = !mesh.texcoords.empty();
  std::string vertices, faces;
  std::map<Vertex, uint32_t> known;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    faces += '\3';
    for (int c = 0; c < 3; ++c) {
      const Vertex v = vertex(mesh, t, c, normals, v_down);
      const auto [at, is_new] = known.try_emplace(v, static_cast<uint32_t>(known.size()));
      if (is_new) {
        append(vertices, v.data(), (normals ? 6 : 3) * sizeof(float));
        if (texcoords) append(vertices, v.data() + 6, 2 * sizeof(float));
      }
      append(faces, &at->second, sizeof(uint32_t));
    }
  }
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(known.size()) + "\n";
  for (const std::string_view name : {"x", "y", "z", "nx", "ny", "nz", "u", "v"}) {
    const bool written = name[0] == 'n' ? normals : name[0] < 'x' ? texcoords : true;
    if (written) text += "property float " + std::string(name) + "\n";
  }
  text += "element face " + std::to_string(mesh.triangles.size()) +
          "\nproperty list uchar int vertex_indices\nend_header\n";
  return text + vertices + faces;
}

Image albedo_map(const Scene& scene, const Material& material) {
  const Texture& texture = scene.textures[material.texture];
  Image map(texture.width, texture.height);
  for (size_t i = 0; i < texture.texels.size(); ++i) {
    const glm::dvec3 albedo = material.reflectance * linear(texture.texels[i]);
    for (int c = 0; c < 3; ++c) map.rgb[3 * i + static_cast<size_t>(c)] = static_cast<float>(albedo[c]);
  }
  return map;
}

std::string albedo_path(const std::string& folder, size_t material) {
  return folder + "/albedo" + std::to_string(material) + ".pfm";
}

std::string mesh_path(const std::string& folder, size_t mesh) { return folder + "/" + std::to_string(mesh) + ".ply"; }

std::string exact(double value) {
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value);
  return {text, end};
}

std::string exact(const glm::dvec3& value) { return exact(value.x) + ' ' + exact(value.y) + ' ' + exact(value.z); }

}  // namespace lanewise
