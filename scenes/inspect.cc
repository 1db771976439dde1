#include "scenes/inspect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "core/types.h"
#include "scenes/quoted.h"

namespace lanewise {
namespace {

using glm::dvec3;
using Kind = Material::Kind;

bool is(const Scene& scene, uint32_t material, Kind kind) { return scene.materials[material].kind == kind; }

double area(const Mesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const dvec3& p = mesh.positions[a];
    sum += glm::length(glm::cross(mesh.positions[b] - p, mesh.positions[c] - p)) / 2;
  }
  return sum;
}

// Gives equal places equal numbers.
class Places {
 public:
  uint32_t number(const dvec3& p) {
    return numbers_.try_emplace({p.x + 0.0, p.y + 0.0, p.z + 0.0}, static_cast<uint32_t>(numbers_.size()))
        .first->second;
  }

 private:
  std::map<std::array<double, 3>, uint32_t> numbers_;
};

std::string count_of(size_t n, const char* one, const char* many) {
  return std::to_string(n) + ' ' + (n == 1 ? one : many);
}

// Of all glass together: a body may be made of several meshes.
void warn_of_open_glass(const Scene& scene, std::vector<std::string>& warnings) {
  struct Edge {
    uint32_t low, high, mesh;
    bool rising;  // the face goes from low to high
  };
  Places places;
  std::vector<Edge> edges;
  for (uint32_t m = 0; m < scene.meshes.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    if (!is(scene, mesh.material, Kind::kGlass)) continue;
    for (const auto& triangle : mesh.triangles) {
      for (int c = 0; c < 3; ++c) {
        const uint32_t a = places.number(mesh.positions[triangle[c]]);
        const uint32_t b = places.number(mesh.positions[triangle[(c + 1) % 3]]);
        edges.push_back({std::min(a, b), std::max(a, b), m, a < b});
      }
    }
  }
  std::ranges::sort(edges, {}, [](const Edge& e) { return std::array{e.low, e.high, e.mesh}; });
  struct Faults {
    size_t open = 0, crowded = 0, turned = 0;
  };
  std::map<uint32_t, Faults> faults;  // by mesh
  for (size_t i = 0; i < edges.size();) {
    size_t end = i;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
    if (end - i == 1) {
      ++faults[edges[i].mesh].open;
    } else if (end - i > 2) {
      ++faults[edges[i].mesh].crowded;
    } else if (edges[i].rising == edges[i + 1].rising) {
      ++faults[edges[i].mesh].turned;
    }
    i = end;
  }
  for (const auto& [m, f] : faults) {
    const std::string who = "mesh " + quoted(scene.meshes[m].name) + " is glass ";
    if (f.open > 0) warnings.push_back(who + "and open: " + count_of(f.open, "edge has", "edges have") + " one face");
    if (f.crowded > 0)
      warnings.push_back(who + "with " + count_of(f.crowded, "edge", "edges") + " of more than two faces");
    if (f.turned > 0) {
      warnings.push_back(who + "with " + count_of(f.turned, "edge", "edges") + " whose faces disagree on the outside");
    }
  }
}

// Same corners, in any order.
void warn_of_doubles(const Scene& scene, std::vector<std::string>& warnings) {
  struct Triangle {
    std::array<uint32_t, 3> corners;
    uint32_t mesh;
  };
  Places places;
  std::vector<Triangle> triangles;
  triangles.reserve(scene.triangle_count());
  for (uint32_t m = 0; m < scene.meshes.size(); ++m) {
    for (const auto& [a, b, c] : scene.meshes[m].triangles) {
      const std::vector<dvec3>& p = scene.meshes[m].positions;
      triangles.push_back({{places.number(p[a]), places.number(p[b]), places.number(p[c])}, m});
      std::ranges::sort(triangles.back().corners);
    }
  }
  std::ranges::sort(triangles, {}, [](const Triangle& t) { return std::pair(t.corners, t.mesh); });
  std::map<std::pair<uint32_t, uint32_t>, size_t> doubles;  // by mesh, and mesh that it lies on
  for (size_t i = 1; i < triangles.size(); ++i) {
    if (triangles[i].corners == triangles[i - 1].corners) ++doubles[{triangles[i].mesh, triangles[i - 1].mesh}];
  }
  for (const auto& [meshes, count] : doubles) {
    warnings.push_back(count_of(count, "triangle", "triangles") + " of mesh " +
                       quoted(scene.meshes[meshes.first].name) + (count == 1 ? " lies" : " lie") +
                       " exactly on those of mesh " + quoted(scene.meshes[meshes.second].name));
  }
}

// Whether any point of the scene is on the triangle's front side, by more than rounding.
bool sees_something(const Scene& scene, const Mesh& mesh, const std::array<uint32_t, 3>& triangle, double margin) {
  const dvec3& p = mesh.positions[triangle[0]];
  const dvec3 n = glm::normalize(glm::cross(mesh.positions[triangle[1]] - p, mesh.positions[triangle[2]] - p));
  const auto in_front = [&](const dvec3& q) { return glm::dot(n, q - p) > margin; };
  for (const Sphere& sphere : scene.spheres) {
    if (in_front(sphere.center + sphere.radius * n)) return true;
  }
  for (const Mesh& other : scene.meshes) {
    for (const auto& corners : other.triangles) {
      for (const uint32_t corner : corners) {
        if (in_front(other.positions[corner])) return true;
      }
    }
  }
  return false;
}

void warn_of_lights(const Scene& scene, std::vector<std::string>& warnings) {
  constexpr size_t kMostLooks = 1000;  // at a light's triangles; each may look at the whole scene
  const double margin = 1e-6 * bounds(scene).diagonal();
  for (const Mesh& mesh : scene.meshes) {
    if (!is(scene, mesh.material, Kind::kEmission) || mesh.triangles.size() > kMostLooks) continue;
    const auto sees = [&](const auto& triangle) { return sees_something(scene, mesh, triangle, margin); };
    if (std::ranges::none_of(mesh.triangles, sees)) {
      warnings.push_back("light " + quoted(mesh.name) + " has nothing in front: it shines away from the whole scene");
    }
  }
  try {
    check_light(scene);
  } catch (const Error&) {
    warnings.push_back("nothing emits light: a render needs an emitter");
  }
}

void warn_of_cameras(const Scene& scene, std::vector<std::string>& warnings) {
  const Bounds box = bounds(scene);
  for (const Camera& camera : scene.cameras) {
    const dvec3 eye(camera.to_world[3]), view = -dvec3(camera.to_world[2]);
    const dvec3 farthest(view.x > 0 ? box.hi.x : box.lo.x, view.y > 0 ? box.hi.y : box.lo.y,
                         view.z > 0 ? box.hi.z : box.lo.z);
    if (glm::dot(farthest - eye, view) <= 0) {
      warnings.push_back("camera " + quoted(camera.name) + " has the whole scene behind it");
    }
  }
}

}  // namespace

std::vector<MaterialUse> material_uses(const Scene& scene) {
  std::vector<MaterialUse> uses(scene.materials.size());
  for (const Mesh& mesh : scene.meshes) uses[mesh.material].triangles += mesh.triangles.size();
  for (const Sphere& sphere : scene.spheres) ++uses[sphere.material].spheres;
  return uses;
}

std::vector<LightFacts> light_facts(const Scene& scene) {
  std::vector<LightFacts> lights;
  const auto add = [&](const std::string& name, uint32_t material, double size) {
    const dvec3& radiance = scene.materials[material].radiance;
    lights.push_back({name, radiance, size, std::numbers::pi * size * radiance});
  };
  for (const Mesh& mesh : scene.meshes) {
    if (is(scene, mesh.material, Kind::kEmission)) add(mesh.name, mesh.material, area(mesh));
  }
  for (const Sphere& sphere : scene.spheres) {
    if (!is(scene, sphere.material, Kind::kEmission)) continue;
    add(sphere.name, sphere.material, 4 * std::numbers::pi * sphere.radius * sphere.radius);
  }
  return lights;
}

std::vector<std::string> scene_warnings(const Scene& scene) {
  std::vector<std::string> warnings;
  warn_of_lights(scene, warnings);
  warn_of_cameras(scene, warnings);
  warn_of_open_glass(scene, warnings);
  warn_of_doubles(scene, warnings);
  const std::vector<MaterialUse> uses = material_uses(scene);
  for (size_t i = 0; i < uses.size(); ++i) {
    const Material& m = scene.materials[i];
    const bool white = std::max({m.reflectance.x, m.reflectance.y, m.reflectance.z}) >= 1;
    if (m.kind == Kind::kDiffuse && white && uses[i].triangles + uses[i].spheres > 0) {
      warnings.push_back("material " + quoted(m.name) +
                         " reflects all light of a colour: between such walls it never ends");
    }
  }
  return warnings;
}

}  // namespace lanewise
