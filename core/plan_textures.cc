#include "core/plan_textures.h"

#include <algorithm>
#include <cmath>

#include "core/types.h"

namespace lanewise {
namespace {

constexpr size_t kMostTexels = size_t{1} << 30;  // an index is an int

void add_texture(const Texture& texture, Plan& plan) {
  plan.textures.push_back({static_cast<float>(texture.width), static_cast<float>(texture.height),
                           static_cast<uint32_t>(plan.texels.size()), 0});
  plan.texels.insert(plan.texels.end(), texture.texels.begin(), texture.texels.end());
}

// The function that is `value` at each corner and constant along n: a.p + a_0.
void push_form(const glm::dvec3 (&v)[3], const glm::dvec3& n, const double (&value)[3], AlignedVector<float>& out) {
  const glm::dvec3 e1 = v[1] - v[0], e2 = v[2] - v[0];
  const double twice_area = glm::dot(n, glm::cross(e1, e2));
  const glm::dvec3 a =
      ((value[1] - value[0]) * glm::cross(e2, n) + (value[2] - value[0]) * glm::cross(n, e1)) / twice_area;
  for (int axis = 0; axis < 3; ++axis) out.push_back(static_cast<float>(a[axis]));
  out.push_back(static_cast<float>(value[0] - glm::dot(a, v[0])));
}

}  // namespace

void add_textures(const Scene& scene, Plan& plan) {
  std::vector<bool> shown(scene.textures.size(), false);
  for (const Mesh& mesh : scene.meshes) {
    if (const uint32_t texture = scene.materials[mesh.material].texture; texture != kNoTexture) shown[texture] = true;
  }
  size_t texels = 0;
  for (size_t i = 0; i < shown.size(); ++i) texels += shown[i] ? scene.textures[i].texels.size() : 0;
  if (texels == 0) return;
  if (texels > kMostTexels) throw Error(scene.path + ": textures of more than 2^30 texels in all");

  add_texture({"", 1, 1, {0xffffff}}, plan);
  std::vector<uint32_t> number(shown.size(), 0);
  for (size_t i = 0; i < shown.size(); ++i) {
    if (!shown[i]) continue;
    number[i] = static_cast<uint32_t>(plan.textures.size());
    add_texture(scene.textures[i], plan);
  }
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    if (const uint32_t texture = scene.materials[i].texture; texture != kNoTexture) {
      plan.materials[i].texture = number[texture];
    }
  }
}

void map_triangle(const Scene& scene, const Mesh& mesh, size_t triangle, const glm::dvec3 (&v)[3], const glm::dvec3& n,
                  Plan& plan) {
  const uint32_t texture = scene.materials[mesh.material].texture;
  double column[3] = {}, row[3] = {};
  if (texture != kNoTexture && !mesh.texcoords.empty()) {
    const Texture& t = scene.textures[texture];
    const auto& at = mesh.texcoords[triangle];
    // As the texture repeats, whole turns may be left out: floats are finer near 0.
    const glm::dvec2 turns = glm::floor(glm::min(glm::min(at[0], at[1]), at[2]));
    for (int k = 0; k < 3; ++k) {
      const glm::dvec2 uv = at[static_cast<size_t>(k)] - turns;
      column[k] = uv.x * t.width - 0.5;
      row[k] = (1 - uv.y) * t.height - 0.5;
    }
  }
  push_form(v, n, column, plan.prim_texture);
  push_form(v, n, row, plan.prim_texture);
}

}  // namespace lanewise
