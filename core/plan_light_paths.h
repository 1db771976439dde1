// Light paths: what lamps send through mirrors, glass and metal onto diffuse surfaces, caustics and their further glow, is followed
// from the lamps, and seen by the camera wherever a path comes to a diffuse surface (light tracing: Arvo, Backward Ray Tracing,
// 1986; the pure light-tracing strategy of Veach 1997, ch. 10). A path from the camera finds such light by chance alone: when it
// is scattered from a diffuse surface to the point of a mirror where a lamp is reflected.
//
// Every way that light takes from a lamp to the camera is counted once, by its surfaces:
//   - by light paths, if the first after the lamp is not diffuse and the last before the camera is (so there are two at least);
//   - by paths from the camera, otherwise. The camera sees a caustic in a mirror by these.
// Where surfaces have normals of their own to be shaded by, the two kinds of path do not see the same scattering, and light paths
// must make up for it (kernel `adjoint`) by factors without a bound, at grazing angles. So a way is left to paths from the camera
// also if at any of its vertices one of the two directions does not agree with the normals: kLeastAgreement.
// There is nothing to weigh: LampsBy says it for the paths from the camera, and light paths begin and end accordingly.
//
// Light paths are aimed at spheres around all surfaces that are not diffuse, the casters. A pass, for each sample that pixels get,
// has so many of them; all passes are one sequence of paths for each lamp, cut into waves.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/plan.h"

namespace lanewise {

// Pixels of the picture for each light path of a pass.
constexpr uint32_t kPixelsPerLightPath = 4;

// A direction w agrees with the surface's normal n and its shading normal s if |w.n| and |w.s| differ by at most the inverse of
// this as a factor. So a vertex of a light path has a factor of 4 at most to make up for.
constexpr float kLeastAgreement = 0.5f;

// Surfaces that scatter and are not diffuse: light comes to others by way of them.
inline bool casts(uint32_t bin) { return bin > kDiffuse && bin < kSurfaceBins; }

// More surfaces than this have one sphere around them all.
constexpr uint32_t kMaxCasters = 16;

// Light paths take a caster for all around a lamp's point from which it is seen under an angle of which the squared sine is this or
// more: the edge of the cone would hang on the last bits of the point.
constexpr float kMostSine2 = 0.99f;

// Fills plan.casters and plan.lamp_paths, or leaves them empty. triangles and spheres: all of the scene's, by prim.
void choose_light_paths(Plan& plan, std::span<const FlatTriangle> triangles, std::span<const FlatSphere> spheres);

// The picture must show diffuse surfaces of this much of the area of a box around the scene: light paths fall everywhere, and few are
// seen where it shows little.
constexpr float kLeastShown = 1 / 16.0f;

// Takes them away where that is not so; when rays can be traced in the plan. size: of the box.
void drop_unseen_light_paths(Plan& plan, const glm::dvec3& size);

inline bool has_light_paths(const Plan& plan) { return !plan.casters.empty(); }

// Why there are none; "" if there are.
const char* why_no_light_paths(const Plan& plan);

// Paths first .. first + count - 1 of a lamp, counted from a pass that is a multiple of 2^32 on; all of one epoch.
struct LightPiece {
  uint32_t light = 0;
  uint32_t count = 0;
  uint64_t first = 0;
  uint64_t epoch = 0;
};

// Passes first_pass .. first_pass + passes - 1 in pieces: some for each worker, none of more than 2^17 paths.
std::vector<LightPiece> light_pieces(const Plan& plan, uint64_t first_pass, uint64_t passes, uint32_t workers);

// Passes that workers are to draw between two pauses: some pieces each.
uint64_t passes_at_a_time(const Plan& plan, uint32_t workers);

}  // namespace lanewise
