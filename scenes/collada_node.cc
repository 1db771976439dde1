#include "scenes/collada_node.h"

#include <cstring>
#include <utility>

#include "scenes/collada_camera.h"
#include "scenes/collada_transform.h"

namespace lanewise::collada {
namespace {

Mesh mesh_of(const Part& part) {
  Mesh mesh;
  mesh.positions = part.positions;
  mesh.triangles = part.triangles;
  mesh.normals = part.normals;
  return mesh;
}

class Instantiator {
 public:
  Instantiator(const Document& document, Library& library, Scene& scene)
      : document_(document), library_(library), scene_(scene) {}

  // Depth is bounded by check_size.
  void visit(pugi::xml_node node, const glm::dmat4& parent_to_world) {
    const glm::dmat4 to_world = parent_to_world * node_transform(document_, node);
    if (!invertible(to_world)) document_.fail(node, "its transform, with those around it, is singular or too large");
    for (const pugi::xml_node child : node.children()) {
      const char* kind = child.name();
      const auto is = [&](const char* name) { return std::strcmp(kind, name) == 0; };
      if (is("node")) {
        visit(child, to_world);
      } else if (is("instance_node")) {
        visit(document_.refer(child, "url", "node"), to_world);
      } else if (is("instance_geometry")) {
        add_geometry(node, child, to_world);
      } else if (is("instance_camera")) {
        scene_.cameras.push_back(read_camera(document_, document_.refer(child, "url", "camera"), to_world));
      } else if (is("instance_light")) {
        add_light(document_.refer(child, "url", "light"), to_world);
      } else if (is("instance_controller")) {
        library_.notice("node " + quoted(name_of(node)) + " instantiates a controller: skipped");
      }
    }
  }

  std::vector<AreaLight> area_lights;

 private:
  void add_geometry(pugi::xml_node node, pugi::xml_node instance, const glm::dmat4& to_world) {
    const Geometry& geometry = library_.geometry(instance);
    if (geometry.radius > 0) add_sphere(node, instance, geometry, to_world);
    for (const Part& part : geometry.parts) {
      Mesh mesh = mesh_of(part);
      mesh.name = name_of(node);
      mesh.material = library_.material(instance, part.symbol, part.element);
      mesh.texcoords = library_.texcoords(instance, part, mesh.material);
      place_mesh(mesh, to_world);
      scene_.meshes.push_back(std::move(mesh));
    }
  }

  void add_sphere(pugi::xml_node node, pugi::xml_node instance, const Geometry& geometry, const glm::dmat4& to_world) {
    const Linear linear = linear_part(to_world);
    if (!linear.uniform) document_.fail(node, "scales a sphere unevenly: ellipsoids are not supported");
    Sphere sphere;
    sphere.name = name_of(node);
    sphere.center = glm::dvec3(to_world[3]);
    sphere.radius = geometry.radius * linear.scale;
    sphere.material = library_.material(instance, "", geometry.element);
    scene_.spheres.push_back(sphere);
  }

  void add_light(pugi::xml_node light, const glm::dmat4& to_world) {
    if (auto area = read_area_light(document_, light, to_world)) {
      area_lights.push_back(*area);
    } else {
      library_.notice("light " + quoted(name_of(light)) + " is not an area light: skipped");
    }
  }

  const Document& document_;
  Library& library_;
  Scene& scene_;
};

}  // namespace

std::vector<AreaLight> instantiate(const Document& document, Library& library, pugi::xml_node node,
                                   const glm::dmat4& to_world, Scene& scene) {
  Instantiator instantiator(document, library, scene);
  instantiator.visit(node, to_world);
  return instantiator.area_lights;
}

}  // namespace lanewise::collada
