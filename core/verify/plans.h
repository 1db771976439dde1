// The plans that the kernels are tried on.
#pragma once

#include <vector>

#include "core/plan.h"

namespace lanewise::verify {

// With trees, smooth normals, many lights, metals from alpha 1e-4 to 1 and glass of index 0.67 to 2.5; and a small one, all
// of whose primitives are in flat lists and which a sphere lights; and one open to the sky.
std::vector<Plan> verification_plans();

// All combinations of what a user chooses about direct light, microfacet sampling and Fresnel.
std::vector<Settings> verification_settings();

}  // namespace lanewise::verify
