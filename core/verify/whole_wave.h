// The kernels that do more than compute a path's fields: they must do it to the bit. Each function runs one, on the target
// chosen at the moment, and returns how many things are wrong.
#pragma once

#include <cstdint>

namespace lanewise::verify {

uint64_t sort_errors(uint32_t paths, uint32_t seed);
uint64_t retire_errors(uint32_t paths, uint32_t seed);
uint64_t accumulate_errors(uint32_t paths, uint32_t seed);
uint64_t count_shadow_rays_errors(uint32_t paths, uint32_t seed);

}  // namespace lanewise::verify
