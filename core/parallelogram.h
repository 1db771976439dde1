// Parallelograms found in triangle pairs: cheaper to intersect and to sample than two triangles.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/plan.h"

namespace lanewise {

// corner + u e1 + v e2 with u, v in [0, 1], or a triangle's half of it, u + v <= 1. Faces where e1 x e2 points.
struct Parallelogram {
  glm::dvec3 corner, e1, e2;
  uint32_t first;   // the index of its triangle,
  uint32_t second;  // and of the one that completes it; kNoPrim: it is that triangle alone

  bool is_triangle() const { return second == kNoPrim; }
  double area() const { return glm::length(glm::cross(e1, e2)) * (is_triangle() ? 0.5 : 1.0); }
};

// Pairs triangles of equal winding that share an edge, vertices equal to the bit, and together form a parallelogram to
// within 1e-6 of its size. Every triangle is in exactly one result; those without a partner stay triangles.
std::vector<Parallelogram> find_parallelograms(std::span<const FlatTriangle> triangles);

}  // namespace lanewise
