// Focus by the scene, as a camera's autofocus does.
#pragma once

#include "core/plan.h"

namespace lanewise {

// The distance along the view axis of what the eye sees at the centre of the whole picture, in scene units. Throws UsageError
// if nothing is there.
double distance_at_center(const Plan& plan);

}  // namespace lanewise
