#include "scenes/collada_camera.h"

#include <cmath>
#include <numbers>

#include "scenes/placing.h"

namespace lanewise::collada {
namespace {

// Radians; 0 if the element is not there.
double read_field_of_view(const Document& document, pugi::xml_node node) {
  if (!node) return 0;
  const double degrees = document.number(node);
  if (!(degrees > 0 && degrees < 180)) document.fail(node, "a field of view must be between 0 and 180 degrees");
  return degrees * (std::numbers::pi / 180);
}

}  // namespace

Camera read_camera(const Document& document, pugi::xml_node element, const glm::dmat4& to_world) {
  const pugi::xml_node common = element.child("optics").child("technique_common");
  if (common.child("orthographic")) document.fail(element, "orthographic cameras are not supported");
  const pugi::xml_node perspective = common.child("perspective");
  if (!perspective) document.fail(element, "has no <perspective>");

  Camera camera;
  camera.name = name_of(element);
  camera.to_world = rigid_frame(to_world);
  const double xfov = read_field_of_view(document, perspective.child("xfov"));
  const double yfov = read_field_of_view(document, perspective.child("yfov"));
  if (xfov == 0 && yfov == 0) document.fail(perspective, "has neither <xfov> nor <yfov>");
  if (const pugi::xml_node aspect = perspective.child("aspect_ratio")) {
    camera.aspect = document.number(aspect);
    if (!(camera.aspect >= 1e-3 && camera.aspect <= 1e3)) document.fail(aspect, "must be between 0.001 and 1000");
  } else if (xfov > 0 && yfov > 0) {
    camera.aspect = std::tan(xfov / 2) / std::tan(yfov / 2);
  }
  camera.xfov = xfov > 0 ? xfov : 2 * std::atan(camera.aspect * std::tan(yfov / 2));
  const double half_width = std::tan(camera.xfov / 2);  // at distance 1
  if (!(half_width > 1e-6 && half_width < 1e6)) {
    document.fail(perspective, "the field of view is too close to 0 or 180 degrees");
  }
  return camera;
}

}  // namespace lanewise::collada
