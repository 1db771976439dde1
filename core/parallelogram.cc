#include "core/parallelogram.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace lanewise {
namespace {

using glm::dvec3;
using Corner = std::array<float, 3>;

constexpr double kTolerance = 1e-6;

dvec3 vertex(const FlatTriangle& t, int k) { return {t.v[k][0], t.v[k][1], t.v[k][2]}; }
Corner key(const FlatTriangle& t, int k) { return {t.v[k][0], t.v[k][1], t.v[k][2]}; }

// The parallelogram that triangle b completes over a's edge (k, k + 1), if it does.
bool completes(const FlatTriangle& a, int k, const FlatTriangle& b, Parallelogram& out) {
  const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
  for (int j = 0; j < 3; ++j) {
    if (key(b, j) != key(a, k1) || key(b, (j + 1) % 3) != key(a, k)) continue;
    // The shared edge is a diagonal; opposite it lie a's corner k2 and one of b's.
    const dvec3 opposite = vertex(b, (j + 2) % 3);
    const dvec3 corner = vertex(a, k2), e1 = vertex(a, k) - corner, e2 = vertex(a, k1) - corner;
    if (glm::length(e1 + e2 - (opposite - corner)) > kTolerance * std::min(glm::length(e1), glm::length(e2)))
      return false;
    out.corner = corner, out.e1 = e1, out.e2 = e2;
    return true;
  }
  return false;
}

}  // namespace

std::vector<Parallelogram> find_parallelograms(std::span<const FlatTriangle> triangles) {
  std::map<std::pair<Corner, Corner>, uint32_t> by_edge;  // directed edge to the triangle that has it
  for (uint32_t i = 0; i < triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) by_edge[{key(triangles[i], k), key(triangles[i], (k + 1) % 3)}] = i;
  }
  std::vector<bool> used(triangles.size(), false);
  std::vector<Parallelogram> result;
  for (uint32_t i = 0; i < triangles.size(); ++i) {
    if (used[i]) continue;
    used[i] = true;
    const FlatTriangle& a = triangles[i];
    const dvec3 corner = vertex(a, 0);
    Parallelogram p{corner, vertex(a, 1) - corner, vertex(a, 2) - corner, i, kNoPrim};
    for (int k = 0; k < 3; ++k) {
      const auto found = by_edge.find({key(a, (k + 1) % 3), key(a, k)});
      if (found == by_edge.end() || used[found->second] || !completes(a, k, triangles[found->second], p)) continue;
      p.second = found->second;
      used[p.second] = true;
      break;
    }
    result.push_back(p);
  }
  return result;
}

}  // namespace lanewise
