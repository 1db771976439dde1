// Scalar twin of kernels/share_paths.cc.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/reference/keep_vertices.h"

namespace lanewise::reference {

template <class T>
using Square = std::array<KeptPath<T>, kPathsTogether>;

// Aims from the first vertex of one path at the second one of another: l = y - x. Returns pi times the density of y there, or 0.
template <class T>
T connect_paths(const KeptPath<T>& first, const KeptPath<T>& second, Vec3<T>& l) {
  l = LANEWISE_VEC3(second, y) - LANEWISE_VEC3(first, x);
  const T leaves = glm::dot(LANEWISE_VEC3(first, n), l), arrives = -glm::dot(LANEWISE_VEC3(second, m), l);
  const T square = glm::dot(l, l);
  return first.bounce == second.bounce && second.gain > 0 && leaves > 0 && arrives > 0
             ? (leaves / square) * (arrives / square)
             : T(0);
}

// results: what each path has retired with; becomes what its pixel gets. sees(i, j, l): whether nothing is in the way from the
// first vertex of path i along l to the second one of path j.
template <class T, class Sees>
void share_paths(const Square<T>& kept, std::array<Vec3<T>, kPathsTogether>& results, const Sees& sees) {
  std::array<Vec3<T>, kPathsTogether> got{};
  std::array<bool, kPathsTogether> shares{};
  for (uint32_t j = 0; j < kPathsTogether; ++j) {
    const Vec3<T> radiance = kept[j].gain * results[j];
    shares[j] = kept[j].gain > 0 && std::isfinite(radiance.x) && std::isfinite(radiance.y) && std::isfinite(radiance.z);
    if (!shares[j]) continue;
    std::array<T, kPathsTogether> weights{};
    T sum = 0;
    for (uint32_t i = 0; i < kPathsTogether; ++i) {
      Vec3<T> l;
      weights[i] = connect_paths(kept[i], kept[j], l);
      if (i != j && weights[i] > 0 && !sees(i, j, l)) weights[i] = 0;
      sum += weights[i];
    }
    if (!(weights[j] > T(kLeastShared))) weights = {}, weights[j] = sum = 1;
    for (uint32_t i = 0; i < kPathsTogether; ++i) got[i] += weights[i] / sum * radiance;
  }
  for (uint32_t i = 0; i < kPathsTogether; ++i) {
    const Vec3<T> own = shares[i] ? LANEWISE_RGB(kept[i], L) : results[i];
    results[i] = own + LANEWISE_RGB(kept[i], f) * got[i];
  }
}

}  // namespace lanewise::reference
