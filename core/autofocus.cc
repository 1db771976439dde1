#include "core/autofocus.h"

#include <cmath>

#include "core/types.h"
#include "kernels/reference/intersect.h"

namespace lanewise {

double distance_at_center(const Plan& plan) {
  const auto eye = reference::vec3<double>(plan.camera.eye), forward = reference::vec3<double>(plan.camera.forward);
  const double distance = reference::closest_hit(plan, eye, glm::normalize(forward)).t;
  if (!std::isfinite(distance)) throw UsageError("--autofocus: nothing is at the centre of the picture");
  return distance;
}

}  // namespace lanewise
