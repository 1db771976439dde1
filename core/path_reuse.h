// Paths of neighbouring pixels used again: light that comes to a diffuse surface from another diffuse one (Bekaert, Sbert & Halton,
// Accelerating Path Tracing by Re-Using Paths, EGWR 2002).
//
// The samples of the same number of kPathsTogether pixels, a square of the picture, are drawn together. Where the path of pixel i
// comes to its first diffuse surface, at x_i, seen by the camera or by way of others, and that of pixel j goes from x_j straight
// to a diffuse surface at y_j, what it finds from there on, the radiance L_j that y_j sends out, is not its pixel's alone: each
// x_i that sees y_j, behind as many scattering events, could have chosen it. By the balance heuristic of all of them (Veach 1997,
// eq. 9.8) pixel i gets
//
//   sum over j of  f_i L_j w_ij,    w_ij = p_i(y_j) V(x_i, y_j) / sum over k of p_k(y_j) V(x_k, y_j)
//
// where p_i is the density, by area, with which x_i chooses y_j (a cosine lobe), V whether they see each other, and f_i the
// throughput of the path behind x_i. So each L_j is shared out with weights that add up to 1. Every pixel's estimate stays
// unbiased by itself; those of a square hang together. It costs a shadow ray for every other pixel of the square.
//
// Shared are vertices without shading normals of their own, and radiance that is a finite number. What falls on x directly, and
// what comes to it from mirrors, glass, metal and emitters, stays with its path.
#pragma once

#include <cstdint>
#include <vector>

#include "core/plan.h"
#include "kernels/kernels.h"

namespace lanewise {

// Throughputs and densities below this are not shared: dividing by them would overflow.
constexpr float kLeastShared = 1e-30f;

constexpr uint32_t kTogetherSide = 2, kPathsTogether = kTogetherSide * kTogetherSide;

// A path's first diffuse vertex is kept at bounces below this: if roulette came between it and the second, the density of that
// would be another.
constexpr uint32_t kFirstBounces = kRouletteBounce;

// Why paths are not used again; "" if they are.
const char* why_no_reuse(const Plan& plan);
inline bool reuses_paths(const Plan& plan) { return *why_no_reuse(plan) == '\0'; }
// Bounces at which there may be such a vertex, 0 to this - 1; 0: paths are not used again.
uint32_t first_bounces(const Plan& plan);

// Of the squares of pixels that hang together.
inline uint32_t side_together(const Plan& plan) { return reuses_paths(plan) ? kTogetherSide : 1; }

// Pixels in whole squares, row by row, each as Batch has them.
struct PixelSquares {
  std::vector<uint32_t> pixels;  // kNoPixel: outside of the picture
  std::vector<uint32_t> slots;   // kNoPixel: not among those that are wanted
};

// The squares of these pixels (y * width + x), in the order in which they come. slots: as Batch has them, of these pixels.
PixelSquares squares_of(const std::vector<uint32_t>& pixels, const uint32_t* slots, uint32_t width, uint32_t height);

}  // namespace lanewise
