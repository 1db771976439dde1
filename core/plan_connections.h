// Connections: next-event estimation by way of one reflection at a sphere. From a rough vertex outside a mirror or glass sphere
// each point of a light is seen reflected in it at most once, and where can be computed (kernels/reflection-inl.h). So light
// that comes by that way is sampled at the rough vertex, as light that comes straight is: manifold next-event estimation (Hanika
// et al., CGF 34(4), 2015) with all roots known. Chance hardly finds it: the light's image in a sphere is small.
//
// A path rough vertex -> sphere -> light is counted there, or at the light where BSDF sampling meets it; which, says the
// density of BSDF sampling at the rough vertex, kMostConnectedPdf.
#pragma once

#include "core/dimensions.h"
#include "core/path_state.h"
#include "core/plan.h"

namespace lanewise {

// With more spheres or lights there are no connections.
constexpr uint32_t kMaxConnectedSpheres = 4;
constexpr uint32_t kMaxConnectedLights = 4;

// Directions of a larger density (per steradian) are left to BSDF sampling, which finds the light in those by itself: the
// weights are 0 and 1 then, which is multiple importance sampling like any other (Veach 1997, sec. 9.2).
constexpr float kMostConnectedPdf = 100;

// Fills plan.connected_spheres: with all mirror and glass spheres, or none, as where the settings leave no connections.
void connect_spheres(Plan& plan);

inline bool connects(const Plan& plan) { return !plan.connected_spheres.empty(); }

// Whether it does so from vertices with this many scattering events behind them: two more must be allowed, and shown.
inline bool connects_at(const Plan& plan, uint32_t bounce) {
  return bounce + 2 <= plan.settings.max_depth && plan.settings.shows(bounce + 2) && connects(plan);
}

// The random numbers of a connection to light step.light: see core/dimensions.h.
inline uint32_t connection_set(const Plan& plan, const Step& step) {
  const uint32_t light = sampled_lights(plan) + step.light;
  return kSetLight + light * plan.settings.light_samples + step.light_sample;
}

}  // namespace lanewise
