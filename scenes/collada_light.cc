#include "scenes/collada_light.h"

#include <algorithm>

#include "scenes/collada_material.h"
#include "scenes/collada_transform.h"

namespace lanewise::collada {
namespace {

bool overlap(const Bounds& a, const Bounds& b) {
  return glm::all(glm::lessThanEqual(a.lo, b.hi)) && glm::all(glm::lessThanEqual(b.lo, a.hi));
}

// The boxes are those of single triangles: an emissive room around the light must not count.
const Mesh* emitter_at(const AreaLight& light, const Scene& scene, size_t meshes) {
  Bounds around;
  for (const glm::dvec3& corner : light.corners) around.add(corner);
  const glm::dvec3 margin(0.01 * around.diagonal());
  around.add(around.lo - margin);
  around.add(around.hi + margin);
  for (size_t i = 0; i < meshes; ++i) {
    const Mesh& mesh = scene.meshes[i];
    if (scene.materials[mesh.material].kind != Material::Kind::kEmission) continue;
    for (const auto& triangle : mesh.triangles) {
      Bounds box;
      for (const uint32_t index : triangle) box.add(mesh.positions[index]);
      if (overlap(around, box)) return &mesh;
    }
  }
  return nullptr;
}

}  // namespace

std::optional<AreaLight> read_area_light(const Document& document, pugi::xml_node element, const glm::dmat4& to_world) {
  const pugi::xml_node area = cgl_technique(element).child("area");
  if (!area) return std::nullopt;
  const pugi::xml_node color = area.child("color");
  if (!color) document.fail(area, "has no <color>");
  AreaLight light;
  light.name = name_of(element);
  light.radiance = read_radiance(document, color);
  const double turn = linear_part(to_world).mirrored ? -0.5 : 0.5;
  const glm::dvec2 square[] = {{-turn, -0.5}, {-turn, 0.5}, {turn, 0.5}, {turn, -0.5}};
  for (int i = 0; i < 4; ++i) light.corners[i] = glm::dvec3(to_world * glm::dvec4(square[i], 0.0, 1.0));
  return light;
}

void add_area_lights(const std::vector<AreaLight>& lights, Scene& scene) {
  const size_t meshes = scene.meshes.size();  // of the file; area lights do not displace each other
  for (const AreaLight& light : lights) {
    if (const Mesh* emitter = emitter_at(light, scene, meshes)) {
      scene.notices.push_back("area light " + quoted(light.name) + " overlaps the emissive mesh " +
                              quoted(emitter->name) + ": dropped, the mesh is the light");
      continue;
    }
    Material material;
    material.name = light.name;
    material.kind = Material::Kind::kEmission;
    material.radiance = light.radiance;
    Mesh mesh;
    mesh.name = light.name;
    mesh.positions.assign(light.corners.begin(), light.corners.end());
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.material = static_cast<uint32_t>(scene.materials.size());
    scene.materials.push_back(material);
    scene.meshes.push_back(mesh);
  }
}

}  // namespace lanewise::collada
