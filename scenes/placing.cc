#include "scenes/placing.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lanewise {
namespace {

double largest(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

glm::dvec3 transform_point(const glm::dmat4& m, const glm::dvec3& p) { return glm::dvec3(m * glm::dvec4(p, 1.0)); }

// A unit vector, or zero for what has no direction.
glm::dvec3 unit_or_zero(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0 && std::isfinite(length) ? v / length : glm::dvec3(0.0);
}

// Brought to a size of one first: a node's scale may be too small or large to be squared.
glm::dvec3 unit(const glm::dvec3& v) { return glm::normalize(v / largest(v)); }

}  // namespace

bool invertible(const glm::dmat4& transform) {
  glm::dmat3 m(transform);
  for (int c = 0; c < 3; ++c) {
    const double size = largest(m[c]);
    if (!(size > 0 && std::isfinite(size))) return false;
    m[c] /= size;
  }
  return std::abs(glm::determinant(m)) > 1e-12;
}

Linear linear_part(const glm::dmat4& transform) {
  const glm::dmat3 m(transform);
  const double size = std::max({largest(m[0]), largest(m[1]), largest(m[2])});
  const glm::dmat3 n = m / size;
  const double determinant = glm::determinant(n);
  Linear linear;
  linear.mirrored = determinant < 0;
  const double sign = linear.mirrored ? -1 : 1;
  linear.cofactor = sign * glm::dmat3(glm::cross(n[1], n[2]), glm::cross(n[2], n[0]), glm::cross(n[0], n[1]));
  const double scale = std::cbrt(std::abs(determinant));
  linear.scale = scale * size;
  constexpr double kTolerance = 1e-4;
  const glm::dmat3 gram = glm::transpose(n) * n;
  linear.uniform = true;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      linear.uniform &= std::abs(gram[i][j] - (i == j ? scale * scale : 0)) <= kTolerance * scale * scale;
    }
  }
  return linear;
}

void place_mesh(Mesh& mesh, const glm::dmat4& to_world) {
  const Linear linear = linear_part(to_world);
  for (glm::dvec3& p : mesh.positions) p = transform_point(to_world, p);
  if (linear.mirrored) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    for (auto& normals : mesh.normals) std::swap(normals[1], normals[2]);
    for (auto& texcoords : mesh.texcoords) std::swap(texcoords[1], texcoords[2]);
  }
  for (size_t i = 0; i < mesh.normals.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const glm::dvec3& p = mesh.positions[a];
    const glm::dvec3 face = glm::cross(mesh.positions[b] - p, mesh.positions[c] - p);
    for (glm::dvec3& n : mesh.normals[i]) {
      n = unit_or_zero(linear.cofactor * unit_or_zero(n));
      if (n == glm::dvec3(0.0)) n = unit_or_zero(face);
    }
  }
}

glm::dmat4 rigid_frame(const glm::dmat4& m) {
  const glm::dvec3 back = unit(glm::dvec3(m[2]));
  const glm::dvec3 right = unit(glm::cross(unit(glm::dvec3(m[1])), back));
  return {glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0), glm::dvec4(back, 0), m[3]};
}

}  // namespace lanewise
