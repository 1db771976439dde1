#include "core/verify/random_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/reference/vec3.h"

namespace lanewise::test {

glm::vec3 random_direction(std::mt19937& rng) {
  std::normal_distribution<float> normal;
  glm::vec3 v;
  do {
    v = {normal(rng), normal(rng), normal(rng)};
  } while (glm::length(v) < 1e-3f);
  return glm::normalize(v);
}

void fill_random(const Plan& plan, std::mt19937& rng, Path<float>& p, uint32_t index) {
  std::uniform_real_distribution<float> unit(0.0f, 1.0f), sides(-1.0f, 1.0f);
  p.pixel = static_cast<uint32_t>(rng() % (plan.settings.width * plan.settings.height));
  p.sample = static_cast<uint32_t>(rng());
  p.slot = index;
  LANEWISE_SET_VEC3(p, o, 0.9f * glm::vec3(sides(rng), sides(rng), sides(rng)));
  const glm::vec3 d = random_direction(rng), n = random_direction(rng);
  LANEWISE_SET_VEC3(p, d, d);
  LANEWISE_SET_RGB(p, beta, glm::vec3(unit(rng), unit(rng), unit(rng)) + 0.01f);
  LANEWISE_SET_RGB(p, L, glm::vec3(unit(rng), unit(rng), unit(rng)));
  p.pdf = rng() % 4 == 0 ? 0.0f : 0.01f + 2 * unit(rng);
  p.lamps = p.sample % 3;
  p.prim = static_cast<uint32_t>(rng() % (plan.triangles + plan.spheres));
  p.t = 0.01f + 3 * unit(rng);
  p.u = unit(rng);
  p.v = unit(rng) * (1 - p.u);
  p.bin = plan.prim_bin[p.prim];
  LANEWISE_SET_VEC3(p, n, n);
  LANEWISE_SET_VEC3(p, s, glm::normalize(n + 0.1f * random_direction(rng)));
  p.err = 1e-6f;
  LANEWISE_SET_VEC3(p, l, (0.1f + unit(rng)) * random_direction(rng));
  p.l_pdf = rng() % 8 == 0 ? 0.0f : 0.01f + 2 * unit(rng);
  LANEWISE_SET_VEC3(p, m, (0.1f + unit(rng)) * random_direction(rng));
  LANEWISE_SET_RGB(p, c, glm::vec3(unit(rng), unit(rng), unit(rng)));
  LANEWISE_SET_RGB(p, a, glm::vec3(unit(rng), unit(rng), unit(rng)));
}

void arrive(std::mt19937& rng, Path<float>& p, float cosine) {
  using reference::Vec3;
  std::uniform_real_distribution<double> turn(0, 2 * std::numbers::pi);
  const Vec3<double> s = glm::normalize(Vec3<double>(p.s_x, p.s_y, p.s_z));
  Vec3<double> b1, b2;
  reference::frame(s, b1, b2);
  const double phi = turn(rng), sine = std::sqrt(std::max(0.0, 1 - double(cosine) * cosine));
  const Vec3<double> d = -reference::to_world<double>({sine * std::cos(phi), sine * std::sin(phi), cosine}, b1, b2, s);
  p.d_x = static_cast<float>(d.x), p.d_y = static_cast<float>(d.y), p.d_z = static_cast<float>(d.z);
}

}  // namespace lanewise::test
