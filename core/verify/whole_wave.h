// The kernels that do more than compute a path's fields: they must do it to the bit. Each function runs one, on the target
// chosen at the moment, and returns how many things are wrong. (More in squares.h.)
#pragma once

#include <cstdint>

namespace lanewise::verify {

double sort_errors(uint32_t paths, uint32_t seed);
double retire_errors(uint32_t paths, uint32_t seed);
double accumulate_errors(uint32_t paths, uint32_t seed);
double count_shadow_rays_errors(uint32_t paths, uint32_t seed);

}  // namespace lanewise::verify
