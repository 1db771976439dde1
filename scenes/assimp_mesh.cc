#include "scenes/assimp_mesh.h"

#include <assimp/mesh.h>

#include <array>
#include <cstring>
#include <unordered_map>

#include "core/types.h"
#include "scenes/quoted.h"

namespace lanewise {
namespace {

glm::dvec3 to_dvec3(const aiVector3D& v) { return {v.x, v.y, v.z}; }

using Place = std::array<float, 3>;

struct PlaceHash {
  size_t operator()(const Place& place) const {
    size_t hash = 0;
    for (const float x : place) {
      uint32_t bits = 0;
      std::memcpy(&bits, &x, sizeof bits);
      hash = (hash ^ bits) * 0x9E3779B97F4A7C15u;
      hash ^= hash >> 29;
    }
    return hash;
  }
};

// For each vertex the mesh's position; adds those that are new.
std::vector<uint32_t> weld(const aiMesh& from, Mesh& mesh) {
  std::unordered_map<Place, uint32_t, PlaceHash> found;
  std::vector<uint32_t> index(from.mNumVertices);
  for (uint32_t v = 0; v < from.mNumVertices; ++v) {
    const aiVector3D& p = from.mVertices[v];
    const Place place = {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};  // without signs of zeros
    const auto [at, is_new] = found.try_emplace(place, static_cast<uint32_t>(mesh.positions.size()));
    if (is_new) mesh.positions.push_back(to_dvec3(p));
    index[v] = at->second;
  }
  return index;
}

}  // namespace

Mesh read_mesh(const std::string& path, const aiMesh& from) {
  Mesh mesh;
  const std::vector<uint32_t> position = weld(from, mesh);
  for (uint32_t f = 0; f < from.mNumFaces; ++f) {
    const aiFace& face = from.mFaces[f];
    for (uint32_t i = 0; i < face.mNumIndices; ++i) {
      if (face.mIndices[i] >= from.mNumVertices) {
        throw Error(path + ": vertex index " + std::to_string(face.mIndices[i]) + " in mesh " +
                    quoted(from.mName.C_Str()) + " is out of range: there are " + std::to_string(from.mNumVertices));
      }
    }
    for (uint32_t i = 2; i < face.mNumIndices; ++i) {
      const uint32_t a = face.mIndices[0], b = face.mIndices[i - 1], c = face.mIndices[i];
      mesh.triangles.push_back({position[a], position[b], position[c]});
      if (from.HasTextureCoords(0)) {
        const aiVector3D* at = from.mTextureCoords[0];
        mesh.texcoords.push_back(
            {glm::dvec2(at[a].x, at[a].y), glm::dvec2(at[b].x, at[b].y), glm::dvec2(at[c].x, at[c].y)});
      }
      if (from.mNormals == nullptr) continue;
      mesh.normals.push_back({to_dvec3(from.mNormals[a]), to_dvec3(from.mNormals[b]), to_dvec3(from.mNormals[c])});
    }
  }
  return mesh;
}

}  // namespace lanewise
