#include "scenes/gltf_camera.h"

#include <cmath>

#include "scenes/placing.h"

namespace lanewise {

Camera read_gltf_camera(const JsonValue& from, const glm::dmat4& to_world) {
  const JsonValue perspective = from["perspective"], yfov = perspective["yfov"], aspect = perspective["aspectRatio"];
  Camera camera;
  camera.name = from["name"].text("");
  camera.to_world = rigid_frame(to_world);
  camera.aspect = aspect.number(camera.aspect);
  if (!(camera.aspect >= 1e-3 && camera.aspect <= 1e3)) aspect.fail("must be between 0.001 and 1000");
  const double half_width = camera.aspect * std::tan(yfov.number(0) / 2);  // at distance 1
  if (!yfov.present() || !(half_width > 1e-6 && half_width < 1e6)) yfov.fail("must be between 0 and 3.14");
  camera.xfov = 2 * std::atan(half_width);
  return camera;
}

}  // namespace lanewise
