#include "scenes/default_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lanewise {

using glm::dvec3;

Camera default_camera(const Scene& scene) {
  constexpr double kDegree = std::numbers::pi / 180, kElevation = 10 * kDegree, kMargin = 1.05;
  const dvec3 front = scene.up.y > 0.5 ? dvec3(0, 0, 1) : dvec3(0, -1, 0);
  const dvec3 back = std::cos(kElevation) * front + std::sin(kElevation) * scene.up;
  const dvec3 right = glm::cross(scene.up, front), up = glm::cross(back, right);

  Camera camera;
  camera.name = "default";
  camera.xfov = 40 * kDegree;
  const double tan_x = std::tan(camera.xfov / 2), tan_y = tan_x / camera.aspect;
  const Bounds box = bounds(scene);
  double distance = 0;  // from the centre, so that every corner is within the view
  for (int corner = 0; corner < 8; ++corner) {
    const auto side = [&](int axis) { return (corner >> axis & 1) != 0 ? box.hi[axis] : box.lo[axis]; };
    const dvec3 p = dvec3(side(0), side(1), side(2)) - box.center();
    const double wide = std::abs(glm::dot(p, right)) / tan_x, high = std::abs(glm::dot(p, up)) / tan_y;
    distance = std::max(distance, glm::dot(p, back) + kMargin * std::max(wide, high));
  }
  camera.to_world = glm::dmat4(glm::dvec4(right, 0), glm::dvec4(up, 0), glm::dvec4(back, 0),
                               glm::dvec4(box.center() + distance * back, 1));
  return camera;
}

}  // namespace lanewise
