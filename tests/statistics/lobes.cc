#include "tests/statistics/lobes.h"

#include <cmath>
#include <numbers>

namespace lanewise::test::lobes {

using std::numbers::pi;

Arrival::Arrival(const Vec& normal, double degrees) {
  z = glm::normalize(normal);
  x = glm::normalize(std::abs(z.z) > 0.9 ? Vec(1, 0, 0) - z.x * z : glm::cross(Vec(0, 0, 1), z));
  y = glm::cross(z, x);
  wo.z = static_cast<float>(std::cos(degrees * pi / 180));  // as the kernel finds it where it is small
  wo.x = std::sqrt(1 - wo.z * wo.z);
  wo.y = 0;
  LANEWISE_SET_VEC3(path, d, glm::vec3(-(wo.x * x + wo.z * z)));
  LANEWISE_SET_VEC3(path, n, glm::vec3(z));
  LANEWISE_SET_VEC3(path, s, glm::vec3(z));
  path.beta_r = path.beta_g = path.beta_b = 1;
  path.pixel = 3;
}

Vec Arrival::next(const PathState& s, uint32_t i) const {
  const Vec d(s.d_x[i], s.d_y[i], s.d_z[i]);
  Vec w(glm::dot(d, x), glm::dot(d, y), glm::dot(d, z));
  int most = 0;
  for (int k = 1; k < 3; ++k) most = std::abs(w[k]) > std::abs(w[most]) ? k : most;
  const double rest = glm::dot(w, w) - w[most] * w[most];
  w[most] = std::copysign(std::sqrt(std::max(1 - rest, 0.0)), w[most]);
  return w;
}

Domain hemisphere(const OfDirection& value) {
  return {{0, 1}, {-pi, pi}, 16, 32, [value](double z2, double phi) {
            const double r = std::sqrt(1 - z2), z = std::sqrt(z2);
            return value(Vec(r * std::cos(phi), r * std::sin(phi), z)) / (2 * z);
          }};
}

Domain lobe(const Vec& wo, double alpha, const OfDirection& value) {
  const auto density = [=](double x, double y) {
    const Vec m(alpha * x, alpha * y, 1);
    const double c = 1 / glm::length(m), wo_h = c * glm::dot(wo, m);
    const Vec wi = 2 * wo_h * c * m - wo;
    if (wi.z <= 0 || wo_h <= 0) return 0.0;
    // dwi = 4 wo.h dh (Walter et al. 2007, eq. 14), dh = c^3 dslopes.
    return value(wi) * 4 * wo_h * c * c * c * alpha * alpha;
  };
  // wi is above the surface within a circle of slopes around (tan theta, 0).
  const auto support = [=](double y) -> Interval {
    const double tan = wo.x / wo.z, m2 = alpha * y * alpha * y, root2 = 1 / (wo.z * wo.z) - m2;
    if (root2 <= 0) return {0, 0};
    const double far = tan + std::sqrt(root2);
    return {(m2 - 1) / far / alpha, far / alpha};
  };
  return {{-5, 5}, {-5, 5}, kLobeSide, kLobeSide, density, support};
}

}  // namespace lanewise::test::lobes
