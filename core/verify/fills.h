// Paths as the kernels meet them, and as they go wrong most easily: grazing, straight on and from behind, at edges, vertices
// and the rims of spheres, in the planes of lights. Each fill is for the kernels that come at that place of a bounce.
#pragma once

#include <random>

#include "core/path_state.h"
#include "core/plan.h"

namespace lanewise::verify {

constexpr uint64_t kFirstLightPath = 5'000'000'000;

void fill_camera_path(const Plan& plan, std::mt19937& rng, Path<float>& p);
void fill_light_path(const Plan& plan, std::mt19937& rng, Path<float>& p);  // before emit
void fill_ray(const Plan& plan, std::mt19937& rng, Path<float>& p);         // before intersect
void fill_hit(const Plan& plan, std::mt19937& rng, Path<float>& p);         // before surface
void fill_emitter_hit(const Plan& plan, std::mt19937& rng, Path<float>& p);
void fill_sky_ray(const Plan& plan, std::mt19937& rng, Path<float>& p);        // before environment
void fill_shading_point(const Plan& plan, std::mt19937& rng, Path<float>& p);  // after surface, of any material
void fill_rough_point(const Plan& plan, std::mt19937& rng, Path<float>& p);    // before connect_sphere
void fill_light_sample(const Plan& plan, std::mt19937& rng, Path<float>& p);   // before light_<material>
void fill_shadow_ray(const Plan& plan, std::mt19937& rng, Path<float>& p);     // before occlude and gather_emission
void fill_connection(const Plan& plan, std::mt19937& rng, Path<float>& p);     // before occlude_connection
void fill_throughput(const Plan& plan, std::mt19937& rng, Path<float>& p);     // before roulette

// Gives the path another material: that of a random prim of the bin. What shading reads of a path does not depend on where
// the prim lies.
void set_prim(const Plan& plan, std::mt19937& rng, Path<float>& p, Bin bin);

}  // namespace lanewise::verify
