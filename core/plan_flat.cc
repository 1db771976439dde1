#include "core/plan_flat.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "core/parallelogram.h"
#include "core/ray_offset.h"

namespace lanewise {
namespace {

using glm::dvec3;

// Rounding errors of a quad's test, in units of 2^-24: 4 of reach for the distance to its plane, and as many each for
// the point there and for a.q + a_0, doubled for directions up to 60 degrees off the normal. A ray that grazes one of
// two quads at a shared edge may be placed wrongly on it, but then it meets the other's plane within 4 units of that
// edge.
constexpr double kQuadUlps = 32;

double sum_abs(const dvec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }
dvec3 to_dvec3(const float* v) { return {v[0], v[1], v[2]}; }

void copy(const dvec3& from, float* to) {
  for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(from[k]);
}

// The linear form that is -1 on the edge through the corner along `other` and 1 on the edge opposite.
void make_axis(const Parallelogram& p, const dvec3& edge, const dvec3& other, double reach, float* a, float& a_0,
               float& margin) {
  const dvec3 n = glm::cross(p.e1, p.e2);
  const dvec3 along = glm::cross(n, other);
  const dvec3 form = along * (2 / glm::dot(along, edge));
  const double offset = -glm::dot(form, p.corner + 0.5 * edge);
  copy(form, a);
  a_0 = static_cast<float>(offset);
  margin = static_cast<float>(kQuadUlps * 0x1p-24 * (sum_abs(form) * reach + std::abs(offset) + 1));
}

FlatQuad make_quad(const Parallelogram& p, uint32_t prim, double camera_reach) {
  double reach = camera_reach;
  for (const dvec3& v : {p.corner, p.corner + p.e1, p.corner + p.e2, p.corner + p.e1 + p.e2}) {
    reach = std::max(reach, sum_abs(v));
  }
  FlatQuad quad{};
  const dvec3 n = glm::normalize(glm::cross(p.e1, p.e2));
  copy(n, quad.n);
  quad.distance = static_cast<float>(glm::dot(n, p.corner + 0.5 * (p.e1 + p.e2)));
  make_axis(p, p.e1, p.e2, reach, quad.a, quad.a_0, quad.a_margin);
  make_axis(p, p.e2, p.e1, reach, quad.b, quad.b_0, quad.b_margin);
  quad.reach = static_cast<float>(reach);
  quad.prim = prim;
  return quad;
}

// Whether geometry lies on both sides of the plane n.p = distance, by more than the distance that ray origins keep
// anyway.
bool divides(const dvec3& n, double distance, std::span<const FlatTriangle> triangles,
             std::span<const FlatSphere> spheres) {
  bool front = false, behind = false;
  const auto add = [&](double lowest, double highest, double reach) {
    const double tolerance = kOffsetUlps * 0x1p-24 * (reach + std::abs(distance));
    front |= highest > tolerance;
    behind |= lowest < -tolerance;
  };
  for (const FlatTriangle& t : triangles) {
    for (const float* v : t.v) {
      const dvec3 p = to_dvec3(v);
      const double side = glm::dot(n, p) - distance;
      add(side, side, sum_abs(p));
    }
    if (front && behind) return true;
  }
  for (const FlatSphere& s : spheres) {
    const dvec3 center = to_dvec3(s.center);
    const double side = glm::dot(n, center) - distance;
    add(side - double{s.radius}, side + double{s.radius}, sum_abs(center) + double{s.radius});
  }
  return front && behind;
}

// Whether two linear forms differ by tolerance at most, but for their sign, at points within reach.
bool same_form(const float* a, float a_0, const float* b, float b_0, double reach, double tolerance) {
  const dvec3 p = to_dvec3(a), q = to_dvec3(b);
  const double sign = glm::dot(p, q) > 0 ? 1 : -1;
  return sum_abs(p - sign * q) * reach + std::abs(double{a_0} - sign * double{b_0}) <= tolerance;
}

// Makes a slab of two faces of the scene's hull, if they are one; q then takes over p's normal and linear forms, of which
// its own differ by less than rounding errors in the test, and both the larger margins.
bool make_slab(const PlanCamera& camera, FlatQuad& p, FlatQuad& q, FlatSlab& slab) {
  const dvec3 n = to_dvec3(p.n), eye = to_dvec3(camera.eye);
  const double reach = std::max(p.reach, q.reach);
  if (!same_form(p.n, 0, q.n, 0, reach, 0x1p-30 * reach)) return false;
  const auto same = [&](const float* form, float form_0) {
    return [&, form, form_0](const float* other, float other_0, float margin) {
      return same_form(form, form_0, other, other_0, reach, margin / kQuadUlps);
    };
  };
  const auto same_a = same(p.a, p.a_0), same_b = same(p.b, p.b_0);
  const bool straight = same_a(q.a, q.a_0, p.a_margin) && same_b(q.b, q.b_0, p.b_margin);
  const bool swapped = same_a(q.b, q.b_0, p.a_margin) && same_b(q.a, q.a_0, p.b_margin);
  if (!straight && !swapped) return false;
  const bool same_side = glm::dot(n, to_dvec3(q.n)) > 0;
  const float q_distance = same_side ? q.distance : -q.distance;
  const bool q_is_upper = q_distance > p.distance;
  const float a_margin = std::max(p.a_margin, straight ? q.a_margin : q.b_margin);
  const float b_margin = std::max(p.b_margin, straight ? q.b_margin : q.a_margin);
  slab = {{p.n[0], p.n[1], p.n[2]},
          {std::min(p.distance, q_distance), std::max(p.distance, q_distance)},
          {p.a[0], p.a[1], p.a[2]},
          p.a_0,
          {p.b[0], p.b[1], p.b[2]},
          p.b_0,
          a_margin,
          b_margin,
          {q_is_upper ? p.prim : q.prim, q_is_upper ? q.prim : p.prim}};
  // Both are on the hull: if they are apart, all geometry is between them. So must be whatever the camera's rays start from.
  const double side = glm::dot(n, eye);
  const double room = double{camera.lens_radius} + kOffsetUlps * 0x1p-24 * reach;
  if (!(slab.distance[0] + room < side && side < slab.distance[1] - room)) return false;
  p.a_margin = a_margin;
  p.b_margin = b_margin;
  const uint32_t prim = q.prim;
  const float distance = q.distance;
  q = p;
  q.prim = prim;
  q.distance = distance;
  for (float& x : q.n) x = same_side ? x : -x;
  return true;
}

// Whether both triangles map the parallelogram's corners to the same place of their texture, to a thousandth of a texel.
bool same_texture(const Plan& plan, const Parallelogram& p, uint32_t first, uint32_t second) {
  if (plan.textures.empty()) return true;
  const float *a = &plan.prim_texture[8 * size_t{first}], *b = &plan.prim_texture[8 * size_t{second}];
  for (const dvec3& v : {p.corner, p.corner + p.e1, p.corner + p.e2, p.corner + p.e1 + p.e2}) {
    for (const int axis : {0, 4}) {
      const double at_a = glm::dot(to_dvec3(a + axis), v) + a[axis + 3],
                   at_b = glm::dot(to_dvec3(b + axis), v) + b[axis + 3];
      if (std::abs(at_a - at_b) > 1e-3) return false;
    }
  }
  return true;
}

}  // namespace

void add_flat_mesh(Plan& plan, std::span<const FlatTriangle> triangles) {
  const double camera_reach = sum_abs(to_dvec3(plan.camera.eye)) + 2 * double{plan.camera.lens_radius};
  for (const Parallelogram& p : find_parallelograms(triangles)) {
    const FlatTriangle& first = triangles[p.first];
    if (p.is_triangle()) {
      plan.flat_triangles.push_back(first);
      continue;
    }
    if (!same_texture(plan, p, first.prim, triangles[p.second].prim)) {
      plan.flat_triangles.push_back(first);
      plan.flat_triangles.push_back(triangles[p.second]);
      continue;
    }
    const FlatQuad quad = make_quad(p, first.prim, camera_reach);
    plan.flat_quads.push_back(quad);
    // Hits on either half are hits of the first, on the quad's plane.
    float* shape = &plan.prim_shape[4 * size_t{quad.prim}];
    std::copy_n(quad.n, 3, shape);
    shape[3] = quad.distance;
    plan.prim_err[quad.prim] = std::max(plan.prim_err[quad.prim], triangle_offset(triangles[p.second].v));
  }
}

void find_blocking_faces(Plan& plan, std::span<const FlatTriangle> triangles, std::span<const FlatSphere> spheres) {
  const auto quads = std::stable_partition(plan.flat_quads.begin(), plan.flat_quads.end(), [&](const FlatQuad& q) {
    return divides(to_dvec3(q.n), q.distance, triangles, spheres);
  });
  plan.blocking_quads = static_cast<uint32_t>(quads - plan.flat_quads.begin());
  const auto faces =
      std::stable_partition(plan.flat_triangles.begin(), plan.flat_triangles.end(), [&](const FlatTriangle& t) {
        const float* shape = &plan.prim_shape[4 * size_t{t.prim}];
        return divides(to_dvec3(shape), shape[3], triangles, spheres);
      });
  plan.blocking_triangles = static_cast<uint32_t>(faces - plan.flat_triangles.begin());
}

void let_all_faces_block(Plan& plan) {
  plan.blocking_quads = static_cast<uint32_t>(plan.flat_quads.size());
  plan.blocking_triangles = static_cast<uint32_t>(plan.flat_triangles.size());
}

void find_slabs(Plan& plan) {
  std::vector<FlatQuad>& quads = plan.flat_quads;
  std::vector<FlatQuad> faces;
  for (size_t i = plan.blocking_quads; i < quads.size();) {
    FlatSlab slab{};
    size_t j = i + 1;
    while (j < quads.size() && !make_slab(plan.camera, quads[i], quads[j], slab)) ++j;
    if (j == quads.size()) {
      ++i;
      continue;
    }
    plan.flat_slabs.push_back(slab);
    faces.insert(faces.end(), {quads[i], quads[j]});
    quads.erase(quads.begin() + static_cast<ptrdiff_t>(j));
    quads.erase(quads.begin() + static_cast<ptrdiff_t>(i));
  }
  plan.single_quads = static_cast<uint32_t>(quads.size());
  quads.insert(quads.end(), faces.begin(), faces.end());
}

}  // namespace lanewise
