// Scalar twin of kernels/texture.cc.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/texture.h"
#include "kernels/reference/shading.h"

namespace lanewise::reference {

// A row or column of the texture, and the share of the one after it; both wrap around.
template <class T>
struct TexelSpan {
  uint32_t first, second;
  T share;

  TexelSpan(T at, float size) {
    const T whole = std::floor(at);
    const T wrapped = whole - T(size) * std::floor(whole / T(size));
    const auto last = static_cast<uint32_t>(size) - 1;
    share = at - whole;
    first = wrapped > 0 ? std::min(static_cast<uint32_t>(wrapped), last) : 0;  // written so that NaN is 0
    second = first == last ? 0 : first + 1;
  }
};

template <class T>
void texture(const Plan& plan, Path<T>& p) {
  const PlanMaterial& material = material_at(plan, p);
  const PlanTexture& t = plan.textures[material.texture];
  const float* map = &plan.prim_texture[size_t{8} * p.prim];
  const Vec3<T> o = LANEWISE_VEC3(p, o);
  const TexelSpan<T> x(glm::dot(vec3<T>(map), o) + map[3], t.width);
  const TexelSpan<T> y(glm::dot(vec3<T>(map + 4), o) + map[7], t.height);
  const auto texel = [&](uint32_t column, uint32_t row) {
    return Vec3<T>(linear(plan.texels[t.first + size_t{row} * static_cast<uint32_t>(t.width) + column]));
  };
  const Vec3<T> upper = glm::mix(texel(x.first, y.first), texel(x.second, y.first), x.share);
  const Vec3<T> lower = glm::mix(texel(x.first, y.second), texel(x.second, y.second), x.share);
  LANEWISE_SET_RGB(p, a, vec3<T>(material.reflectance) * glm::mix(upper, lower, y.share));
}

}  // namespace lanewise::reference
