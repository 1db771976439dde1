#include "core/render_identity.h"

#include <algorithm>
#include <cstdio>

#include "core/fnv.h"

namespace lanewise {
namespace {

void add(Fnv& fnv, const glm::dvec3& v) {
  for (int i = 0; i < 3; ++i) fnv.add(v[i]);
}

void add(Fnv& fnv, const Material& m) {
  fnv.add(static_cast<uint64_t>(m.kind));
  fnv.add(uint64_t{m.texture});
  for (const double x : {m.ior, m.roughness, m.alpha}) fnv.add(x);
  for (const glm::dvec3& v : {m.reflectance, m.transmittance, m.eta, m.k, m.radiance}) add(fnv, v);
}

void add(Fnv& fnv, const Mesh& mesh) {
  fnv.add(uint64_t{mesh.material});
  fnv.add(uint64_t{mesh.positions.size()});
  for (const glm::dvec3& p : mesh.positions) add(fnv, p);
  fnv.add(uint64_t{mesh.triangles.size()});
  for (const auto& triangle : mesh.triangles) {
    for (const uint32_t i : triangle) fnv.add(uint64_t{i});
  }
  fnv.add(uint64_t{mesh.normals.size()});
  for (const auto& corners : mesh.normals) {
    for (const glm::dvec3& n : corners) add(fnv, n);
  }
  fnv.add(uint64_t{mesh.texcoords.size()});
  for (const auto& corners : mesh.texcoords) {
    for (const glm::dvec2& uv : corners) fnv.add(uv.x), fnv.add(uv.y);
  }
}

std::string scene_hash(const Scene& scene) {
  Fnv fnv;
  for (const Material& material : scene.materials) add(fnv, material);
  for (const Texture& texture : scene.textures) {
    fnv.add(uint64_t{texture.width});
    fnv.add(texture.texels);
  }
  for (const Mesh& mesh : scene.meshes) add(fnv, mesh);
  for (const Sphere& sphere : scene.spheres) {
    add(fnv, sphere.center);
    fnv.add(sphere.radius);
    fnv.add(uint64_t{sphere.material});
  }
  for (const Camera& camera : scene.cameras) {
    for (int c = 0; c < 4; ++c) {
      for (int r = 0; r < 4; ++r) fnv.add(camera.to_world[c][r]);
    }
    fnv.add(camera.xfov);
    fnv.add(camera.aspect);
  }
  fnv.add(uint64_t{scene.environment.width});
  fnv.add(scene.environment.rgb);
  add(fnv, scene.up);
  return fnv.hex();
}

// Before the number of what has a name on the command line: a number that says nothing to a user.
constexpr char kChoice = '#';

constexpr const char* kEven = "even";  // as on the command line

template <class T>
std::string choice(T value) {
  return kChoice + std::to_string(static_cast<int>(value));
}

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

}  // namespace

RenderIdentity render_identity(const Scene& scene, const Settings& s, const std::string& arithmetic) {
  const bool adaptive = s.adaptive_batch > 0 || s.noise > 0;
  return {{"scene", scene_hash(scene)},
          {"resolution", std::to_string(s.width) + " x " + std::to_string(s.height)},
          {"crop", std::to_string(s.window().x) + " " + std::to_string(s.window().y) + " " +
                       std::to_string(s.window().width) + " " + std::to_string(s.window().height)},
          {"seed", std::to_string(s.seed)},
          {"sampler", choice(s.sampler)},
          {"allocation", s.allocation == Allocation::kEven ? kEven : "noise"},
          {"view", choice(s.view)},
          {"lens-radius", number(s.lens_radius)},
          {"focal-distance", s.autofocus ? "auto" : number(s.focal_distance)},
          {"light-samples", std::to_string(s.light_samples)},
          {"max-depth", std::to_string(s.max_depth)},
          {"only-bounce", s.only_bounce ? std::to_string(*s.only_bounce) : "none"},
          {"direct", choice(s.direct)},
          {"light-paths", choice(s.light_paths)},
          {"reuse", choice(s.reuse)},
          {"connect", choice(s.connect)},
          {"bsdf-sampling", choice(s.bsdf_sampling)},
          {"fresnel", choice(s.fresnel)},
          {"model", choice(s.course.masking + 2 * s.course.clamp)},
          {"accel", choice(s.accel)},
          {"adaptive", std::to_string(s.adaptive_batch) + " " +
                           (s.adaptive_batch > 0 ? number(s.adaptive_tolerance) : std::string("0"))},
          {"noise", number(s.noise)},
          {"spp", adaptive ? std::to_string(s.spp) : "any"},
          {"arithmetic", arithmetic}};
}

bool all_have_the_same(const RenderIdentity& identity) {
  const auto found = std::ranges::find(identity, "allocation", [](const auto& entry) { return entry.first; });
  return found == identity.end() || found->second == kEven;
}

std::string arithmetic_of(const std::string& isa) {
  if (isa == "avx2" || isa == "avx512") return "fused multiply-add";  // and the same operations otherwise
  return isa;
}

std::string difference(const RenderIdentity& expected, const RenderIdentity& other) {
  for (size_t i = 0; i < expected.size(); ++i) {
    const auto& [flag, value] = expected[i];
    if (i >= other.size() || other[i].first != flag) return flag + " is not known";
    if (other[i].second == value) continue;
    if (flag == "scene") return "of another scene (or the scene has changed)";
    if (value.starts_with(kChoice)) return flag + " is another";
    return flag + " is " + other[i].second + ", not " + value;
  }
  return {};
}

}  // namespace lanewise
