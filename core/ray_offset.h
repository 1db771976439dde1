// How far off a primitive a ray must start so as not to meet it again.
#pragma once

#include <algorithm>
#include <cmath>

namespace lanewise {

// In units of u = 2^-24, half an ulp of 1. Derivation, to first order in u:
//
// Triangle, R = the largest |x| + |y| + |z| of its vertices, so that it holds for every point p of it, and distances
// from p to vertices are at most 2 R: the plane (n, n.p) that p is put onto is rounded from the true one, 2 u R; the
// sum n.p - dist and p itself are rounded, 4 u R; adding the offset rounds again, u R. The test then rounds the
// vertices relative to the origin and shears them, 3 u 2R along each axis, and its edge functions, sum and quotient act
// like 6 u of 2R more on the depth: 18 u R in the worst case of aligned signs, a third of that in practice. Together
// below 25 u R.
//
// Sphere, R = |center|_1 + radius: the unit normal is good to 5 u, so p to 5 u radius + u |p|; the offset rounds by u
// |p|; center - origin by u radius, and its square minus radius^2 by 3 u radius^2, that is 1.5 u radius in depth.
// Together below 13 u R. A ray that leaves along the tangent misses if 2 radius err exceeds the discriminant's error, 5
// u radius^2.
constexpr float kOffsetUlps = 32;

// v[vertex][axis]
inline float triangle_offset(const float (&v)[3][3]) {
  float reach = 0;
  for (const auto& p : v) reach = std::max(reach, std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]));
  return kOffsetUlps * 0x1p-24f * reach;
}

inline float sphere_offset(const float* center, float radius) {
  return kOffsetUlps * 0x1p-24f * (std::abs(center[0]) + std::abs(center[1]) + std::abs(center[2]) + radius);
}

}  // namespace lanewise
