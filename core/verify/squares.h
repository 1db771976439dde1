// Kernels by which paths are used again (core/path_reuse.h), in which the paths of a square meet: against their twins in double
// precision. Each function runs one, on the target chosen at the moment, and returns how far off the worst is.
#pragma once

#include <cstdint>

namespace lanewise::verify {

// In things that are not as the twin has them, to the bit.
double keep_first_error(uint32_t paths, uint32_t seed);
// In ulps of a number; of a point, of its distance from the origin or the largest coordinate around it.
double keep_second_error(uint32_t paths, uint32_t seed);
// In ulps of the vector, and of the density in front of both surfaces.
double connect_paths_error(uint32_t paths, uint32_t seed);
// In ulps of all that is shared in the square, where no surface is grazed. Where some are, of the sum of the results, which is
// what is shared.
double share_paths_error(uint32_t paths, uint32_t seed);

}  // namespace lanewise::verify
