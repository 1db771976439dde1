#include "core/framing.h"

#include <cmath>

namespace lanewise {

using glm::dvec3;

Framing frame(const Scene& scene, const Settings& settings) {
  const Camera& camera = scene.cameras.front();
  const Bounds box = bounds(scene);
  const double width = settings.width, height = settings.height;
  double tan_x = std::tan(camera.xfov / 2), tan_y = tan_x / camera.aspect;
  if (tan_x / tan_y < width / height) {
    tan_x = tan_y * width / height;
  } else {
    tan_y = tan_x / (width / height);
  }
  Framing framing;
  framing.right = glm::normalize(dvec3(camera.to_world[0]));
  framing.back = glm::normalize(dvec3(camera.to_world[2]));
  if (settings.view == View::kFile) {
    framing.eye = dvec3(camera.to_world[3]) - box.center();
    framing.up = glm::normalize(glm::cross(framing.back, framing.right));
    framing.pixel = 2 * tan_y / height;
  } else {
    framing.eye = framing.back * (1.5 * box.diagonal());
    const bool level = std::abs(glm::dot(scene.up, framing.back)) < 0.999;
    if (level) framing.right = glm::normalize(glm::cross(scene.up, framing.back));
    framing.up = glm::cross(framing.back, framing.right);
    framing.pixel = 2 * tan_y / 600;
  }
  return framing;
}

}  // namespace lanewise
