#include "core/plan.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <span>

#include "core/autofocus.h"
#include "core/dimensions.h"

#include "core/framing.h"
#include "core/plan_connections.h"
#include "core/plan_flat.h"
#include "core/plan_light_paths.h"
#include "core/plan_lights.h"
#include "core/plan_textures.h"
#include "core/plan_trees.h"
#include "core/ray_offset.h"
#include "core/scene.h"

namespace lanewise {
namespace {

using glm::dvec3;

void copy(const dvec3& from, float* to) {
  for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(from[k]);
}

Bin bin_of(const Material& m) {
  switch (m.kind) {
    case Material::Kind::kDiffuse:
      return kDiffuse;
    case Material::Kind::kMicrofacet:
      return kMicrofacet;
    case Material::Kind::kMirror:
      return kMirror;
    case Material::Kind::kGlass:
      return is_rough_glass(m) ? kRoughGlass : kGlass;
    case Material::Kind::kEmission:
      return kEmitter;
  }
  return kDiffuse;
}

PlanMaterial compile(const Material& m) {
  PlanMaterial out{};
  copy(m.reflectance, out.reflectance);
  copy(m.transmittance, out.transmittance);
  out.ior = static_cast<float>(m.ior);
  out.alpha = static_cast<float>(m.kind == Material::Kind::kGlass ? m.roughness : m.alpha);
  copy(m.eta, out.eta);
  copy(m.k, out.k);
  return out;
}

class Planner {
 public:
  // expendable: the scene again if its meshes may be emptied, or null.
  Planner(const Scene& scene, Scene* expendable, const Settings& settings)
      : scene_(scene), expendable_(expendable), box_(bounds(scene)) {
    plan_.settings = settings;
    for (int k = 0; k < 3; ++k) plan_.center[k] = box_.center()[k];
  }

  Plan run() {
    place_camera();
    for (const Material& m : scene_.materials) plan_.materials.push_back(compile(m));
    add_textures(scene_, plan_);
    choose_flat_meshes();
    add_triangles();
    add_spheres();
    choose_light_paths(plan_, corners_, spheres_);
    find_blocking_faces(plan_, corners_, has_light_paths(plan_) ? spheres_and_camera() : spheres_);
    find_slabs(plan_);
    plan_.environment = make_environment_map(scene_.environment, box_.diagonal(), scene_.up.y > 0.5);
    if (!plan_.environment.empty()) let_all_faces_block(plan_);
    build_trees();
    drop_unseen_light_paths(plan_, box_.hi - box_.lo);  // which changes no blocking faces: some may be tested in vain
    focus();
    choose_stages();
    connect_spheres(plan_);
    check_random_sets();
    return std::move(plan_);
  }

 private:
  dvec3 relative(const dvec3& p) const { return p - box_.center(); }

  void place_camera() {
    const Framing framing = frame(scene_, plan_.settings);
    PlanCamera& out = plan_.camera;
    copy(framing.eye, out.eye);
    copy(-framing.back, out.forward);
    copy(framing.right, out.right);
    copy(framing.up, out.up);
    out.pixel = static_cast<float>(framing.pixel);
    out.lens_radius = static_cast<float>(plan_.settings.lens_radius);
  }

  // Light paths send shadow rays there.
  std::vector<FlatSphere> spheres_and_camera() const {
    std::vector<FlatSphere> spheres = spheres_;
    FlatSphere camera{};
    std::copy_n(plan_.camera.eye, 3, camera.center);
    camera.radius = plan_.camera.lens_radius;
    spheres.push_back(camera);
    return spheres;
  }

  void focus() {
    Settings& settings = plan_.settings;
    if (settings.autofocus) settings.focal_distance = distance_at_center(plan_);
    plan_.camera.lens_angle = static_cast<float>(settings.lens_radius / settings.focal_distance);
  }

  // The smallest meshes first, as long as the flat list stays short.
  void choose_flat_meshes() {
    std::vector<size_t> by_size(scene_.meshes.size());
    for (size_t i = 0; i < by_size.size(); ++i) by_size[i] = i;
    std::stable_sort(by_size.begin(), by_size.end(), [&](size_t a, size_t b) {
      return scene_.meshes[a].triangles.size() < scene_.meshes[b].triangles.size();
    });
    is_flat_mesh_.assign(scene_.meshes.size(), false);
    if (plan_.settings.accel == Accel::kTree) return;
    size_t flat = 0;
    for (const size_t i : by_size) {
      const size_t n = scene_.meshes[i].triangles.size();
      if (n > kMaxFlatMesh || flat + n > kMaxFlatTriangles) break;
      is_flat_mesh_[i] = true;
      flat += n;
    }
  }

  void add_triangles() {
    if (scene_.triangle_count() + scene_.spheres.size() >= size_t{1} << 29) {
      throw Error(scene_.path + ": more than 2^29 primitives");
    }
    reserve();
    bool any_smooth = false;
    for (size_t m = 0; m < scene_.meshes.size(); ++m) {
      const Mesh& mesh = scene_.meshes[m];
      const uint32_t first = plan_.triangles;
      bool smooth = false;
      for (size_t t = 0; t < mesh.triangles.size(); ++t) smooth |= add_triangle(mesh, t);
      any_smooth |= smooth;
      plan_.groups.push_back({mesh.name, first, plan_.triangles - first, is_flat_mesh_[m], smooth});
      const std::span<const FlatTriangle> added = std::span(corners_).subspan(first);
      in_tree_.resize(plan_.triangles, !is_flat_mesh_[m]);
      if (is_flat_mesh_[m] && smooth) {
        plan_.flat_triangles.insert(plan_.flat_triangles.end(), added.begin(), added.end());
      } else if (is_flat_mesh_[m]) {
        add_flat_mesh(plan_, added);
      }
      if (scene_.materials[mesh.material].kind == Material::Kind::kEmission) {
        add_mesh_light(plan_, added, scene_.materials[mesh.material].radiance);
        std::fill(plan_.prim_light.begin() + first, plan_.prim_light.end(),
                  static_cast<uint32_t>(plan_.lights.size() - 1));
      }
      if (expendable_) expendable_->meshes[m] = Mesh();
    }
    if (!any_smooth) plan_.prim_normals = AlignedVector<float>();
  }

  void reserve() {
    const size_t triangles = scene_.triangle_count(), primitives = triangles + scene_.spheres.size();
    corners_.reserve(triangles);
    plan_.prim_normals.reserve(9 * triangles);
    plan_.prim_shape.reserve(4 * primitives);
    plan_.prim_err.reserve(primitives);
    plan_.prim_material.reserve(primitives);
    plan_.prim_bin.reserve(primitives);
    plan_.prim_light.reserve(primitives);
  }

  // Returns whether its shading normals differ from its face's.
  bool add_triangle(const Mesh& mesh, size_t index) {
    FlatTriangle corners{};
    dvec3 v[3];
    for (int k = 0; k < 3; ++k) {
      copy(relative(mesh.positions[mesh.triangles[index][static_cast<size_t>(k)]]), corners.v[k]);
      v[k] = dvec3(corners.v[k][0], corners.v[k][1], corners.v[k][2]);
    }
    const dvec3 n = glm::normalize(glm::cross(v[1] - v[0], v[2] - v[0]));
    corners.prim = plan_.triangles++;
    corners_.push_back(corners);
    add_primitive(n, glm::dot(n, (v[0] + v[1] + v[2]) / 3.0), triangle_offset(corners.v), mesh.material);
    if (!plan_.textures.empty()) map_triangle(scene_, mesh, index, v, n, plan_);

    bool smooth = false;
    for (size_t k = 0; k < 3; ++k) {
      const dvec3 corner_normal = mesh.normals.empty() ? n : mesh.normals[index][k];
      smooth |= std::abs(glm::dot(corner_normal, n)) < 1 - 0.5 * kFlatness * kFlatness;
      for (int axis = 0; axis < 3; ++axis) plan_.prim_normals.push_back(static_cast<float>(corner_normal[axis]));
    }
    return smooth;
  }

  void add_spheres() {
    for (const Sphere& sphere : scene_.spheres) {
      FlatSphere out{};
      copy(relative(sphere.center), out.center);
      out.radius = static_cast<float>(sphere.radius);
      out.prim = plan_.triangles + plan_.spheres++;
      spheres_.push_back(out);
      add_primitive(relative(sphere.center), sphere.radius, sphere_offset(out.center, out.radius), sphere.material);
      if (!plan_.textures.empty()) plan_.prim_texture.resize(plan_.prim_texture.size() + 8, 0.0f);
      if (scene_.materials[sphere.material].kind == Material::Kind::kEmission) {
        add_sphere_light(plan_, out, scene_.materials[sphere.material].radiance);
        plan_.prim_light.back() = static_cast<uint32_t>(plan_.lights.size() - 1);
      }
    }
  }

  void add_primitive(const dvec3& shape, double w, float err, uint32_t material) {
    for (int axis = 0; axis < 3; ++axis) plan_.prim_shape.push_back(static_cast<float>(shape[axis]));
    plan_.prim_shape.push_back(static_cast<float>(w));
    plan_.prim_err.push_back(err);
    plan_.prim_material.push_back(material);
    const Bin bin = bin_of(scene_.materials[material]);
    plan_.prim_bin.push_back(bin);
    plan_.prim_light.push_back(0);
    has_bin_[bin] = true;
  }

  void build_trees() {
    std::erase_if(corners_, [&](const FlatTriangle& t) { return !in_tree_[t.prim]; });
    plant_triangles(plan_, corners_);
    const bool few = spheres_.size() <= kMaxFlatSpheres && plan_.settings.accel == Accel::kPlan;
    if (few) {
      plan_.flat_spheres = spheres_;
    } else {
      plant_spheres(plan_, spheres_);
    }
    if (plan_.spheres > 0) plan_.groups.push_back({"spheres", plan_.triangles, plan_.spheres, few});
  }

  void choose_stages() {
    const bool textured = !plan_.textures.empty();
    const ShadeStages all[] = {
        {kDiffuse, textured ? Stage::kLightTextured : Stage::kLightDiffuse,
         textured ? Stage::kShadeTextured : Stage::kShadeDiffuse},
        {kMicrofacet, Stage::kLightMicrofacet, Stage::kShadeMicrofacet},
        {kRoughGlass, Stage::kLightRoughGlass, Stage::kShadeRoughGlass},
        {kMirror, Stage::kCount, Stage::kShadeMirror},
        {kGlass, Stage::kCount, Stage::kShadeGlass},
    };
    for (const ShadeStages& stages : all) {
      if (has_bin_[stages.bin]) plan_.shade_stages.push_back(stages);
    }
  }

  // Every light sample of a vertex draws a set of its own.
  void check_random_sets() const {
    const uint64_t lights = sampled_lights(plan_) + (connects(plan_) ? plan_.lights.size() : 0);
    const uint64_t sets = lights * plan_.settings.light_samples;
    if (sets > kSetsPerBounce - kSetLight) {
      throw Error(scene_.path + ": " + std::to_string(sampled_lights(plan_)) + " lights with " +
                  std::to_string(plan_.settings.light_samples) + " samples each are too many; at most " +
                  std::to_string(kSetsPerBounce - kSetLight) + " samples a vertex");
    }
  }

  const Scene& scene_;
  Scene* expendable_;
  Bounds box_;
  Plan plan_{};
  std::vector<bool> is_flat_mesh_;
  std::vector<FlatTriangle> corners_;  // of all triangles, by prim; in the end of those in the tree
  std::vector<bool> in_tree_;          // which of them go there
  std::vector<FlatSphere> spheres_;
  bool has_bin_[kBinCount] = {};
};

}  // namespace

Plan make_plan(const Scene& scene, const Settings& settings) { return Planner(scene, nullptr, settings).run(); }
Plan make_plan(Scene&& scene, const Settings& settings) { return Planner(scene, &scene, settings).run(); }

}  // namespace lanewise
