// Random content for paths, for tests and benchmarks of kernels.
#pragma once

#include <glm/glm.hpp>
#include <random>

#include "core/path_state.h"
#include "core/plan.h"

namespace lanewise::test {

// A unit vector, every direction as likely.
glm::vec3 random_direction(std::mt19937& rng);

// Random but plausible content for every field: unit directions and normals with s near n, positive throughput, prims
// of the plan, distinct pixels, samples and slots.
void fill_random(const Plan& plan, std::mt19937& rng, Path<float>& p, uint32_t index);

// Turns the path to arrive at the given cosine to its shading normal: positive from its front, negative from behind.
void arrive(std::mt19937& rng, Path<float>& p, float cosine);

}  // namespace lanewise::test
