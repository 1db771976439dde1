#include "core/verify/fills.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "core/verify/fields.h"
#include "core/verify/random_path.h"
#include "kernels/reference/intersect.h"
#include "kernels/reference/sample_environment.h"
#include "kernels/reference/sample_light.h"
#include "kernels/reference/surface.h"

namespace lanewise::verify {
namespace {

using glm::dvec3;
using Rng = std::mt19937;

double unit(Rng& rng) { return std::uniform_real_distribution<double>(0, 1)(rng); }
// Evenly spread over the powers of ten from 10^-decades to 1.
double small(Rng& rng, double decades) { return std::pow(10.0, -decades * unit(rng)); }
double either_sign(Rng& rng) { return rng() % 2 ? 1 : -1; }

dvec3 random_unit(Rng& rng) {
  const double z = 2 * unit(rng) - 1, phi = 2 * std::numbers::pi * unit(rng), r = std::sqrt(1 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}
dvec3 across(Rng& rng, const dvec3& n) { return glm::normalize(glm::cross(n, random_unit(rng))); }

// At an angle to the unit vector n of which the cosine is small, near 1, or anything, of either sign.
dvec3 near_or_grazing(Rng& rng, const dvec3& n) {
  const double kind = unit(rng);
  const double sine = kind < 0.3 ? small(rng, 6) : kind < 0.6 ? std::sqrt(1 - std::pow(small(rng, 6), 2)) : unit(rng);
  return either_sign(rng) * std::sqrt(1 - sine * sine) * n + sine * across(rng, n);
}

void set(float& x, float& y, float& z, const dvec3& v) {
  x = static_cast<float>(v.x), y = static_cast<float>(v.y), z = static_cast<float>(v.z);
}
void set_o(Path<float>& p, const dvec3& v) { set(p.o_x, p.o_y, p.o_z, v); }
void set_d(Path<float>& p, const dvec3& v) { set(p.d_x, p.d_y, p.d_z, v); }
void set_l(Path<float>& p, const dvec3& v) { set(p.l_x, p.l_y, p.l_z, v); }

dvec3 point_in(Rng& rng) { return {2 * unit(rng) - 1, 2 * unit(rng) - 1, 1.4 * (unit(rng) - 0.5)}; }

// The corners of a random triangle or quad that rays are tested against.
std::vector<dvec3> random_face(const Plan& plan, Rng& rng) {
  const size_t quads = plan.flat_quads.size(), flat = plan.flat_triangles.size();
  const bool in_tree = !plan.triangle_blocks.empty() && rng() % 2;
  if (in_tree || quads + flat == 0) {
    const TriangleBlock& block = plan.triangle_blocks[rng() % plan.triangle_blocks.size()];
    std::vector<dvec3> corners;
    for (const auto& v : block.v) corners.emplace_back(v[0][0], v[1][0], v[2][0]);  // the first of each block is in use
    return corners;
  }
  const size_t i = rng() % (quads + flat);
  if (i < flat) {
    const FlatTriangle& t = plan.flat_triangles[i];
    return {reference::vec3<double>(t.v[0]), reference::vec3<double>(t.v[1]), reference::vec3<double>(t.v[2])};
  }
  const FlatQuad& q = plan.flat_quads[i - flat];
  const glm::dmat3 to_point = glm::inverse(glm::transpose(
      glm::dmat3(reference::vec3<double>(q.n), reference::vec3<double>(q.a), reference::vec3<double>(q.b))));
  std::vector<dvec3> corners;
  for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    corners.push_back(to_point * dvec3(q.distance, a - double{q.a_0}, b - double{q.b_0}));
  }
  return corners;
}

// A point of an edge, often near a corner, but not in it: which of the faces around a corner is hit there is a matter of how
// each was rounded, and no choice of the ray's. (That one of them is hit, tests of closed meshes check.)
dvec3 random_edge_point(const Plan& plan, Rng& rng) {
  const std::vector<dvec3> corners = random_face(plan, rng);
  const size_t k = rng() % corners.size();
  return glm::mix(corners[k], corners[(k + 1) % corners.size()], rng() % 3 == 0 ? small(rng, 5) : unit(rng));
}

// A point at the rim of a random sphere as seen from o, or as little within or beside it as a share of 10^-6.
dvec3 random_rim_point(const Plan& plan, Rng& rng, const dvec3& o) {
  const float* sphere = &plan.prim_shape[4 * size_t{plan.triangles + rng() % plan.spheres}];
  const dvec3 center = reference::vec3<double>(sphere);
  const double radius = sphere[3], distance2 = glm::dot(o - center, o - center);
  if (distance2 <= radius * radius) return center + radius * random_unit(rng);
  const double sine = radius / std::sqrt(distance2) * (1 + either_sign(rng) * small(rng, 6) * small(rng, 1));
  const dvec3 axis = glm::normalize(center - o);
  const double s = std::min(sine, 0.99);
  return o + std::sqrt(distance2) * (std::sqrt(1 - s * s) * axis + s * across(rng, axis));
}

// What makes a ray hard: where it goes.
dvec3 hard_target(const Plan& plan, Rng& rng, const dvec3& o) {
  const uint32_t kind = rng() % 8;
  if (kind == 0 && plan.spheres > 0) return random_rim_point(plan, rng, o);
  if (kind == 1) return rng() % 8 == 0 ? random_edge_point(plan, rng) : point_in(rng);
  if (kind == 2) {  // along an axis, or nearly
    dvec3 axis(0);
    axis[static_cast<int>(rng() % 3)] = either_sign(rng);
    return o + axis + (rng() % 2 ? small(rng, 12) * random_unit(rng) : dvec3(0));
  }
  if (kind == 3) {  // in the plane of a face, or nearly
    const std::vector<dvec3> face = random_face(plan, rng);
    const dvec3 n = glm::normalize(glm::cross(face[1] - face[0], face[2] - face[0]));
    return o + across(rng, n) + either_sign(rng) * small(rng, 6) * n;
  }
  return point_in(rng);
}

void start(const Plan& plan, Rng& rng, Path<float>& p) {
  const uint32_t slot = p.slot;
  const Step step = p.step;
  test::fill_random(plan, rng, p, slot);
  p.step = step;
  if (rng() % 16 == 0) p.beta_r = p.beta_g = p.beta_b = 0;
}

// Aims at the light of the path's step.
void sample_light(const Plan& plan, Path<float>& p) {
  Path<double> exact = convert_path<double>(p);
  const bool sky = is_environment(plan, p.step.light);
  sky ? reference::sample_environment(plan, exact) : reference::sample_light(plan, exact);
  p = convert_path<float>(exact);
}

uint32_t random_prim(const Plan& plan, Rng& rng, uint32_t bin) {
  const uint32_t prims = plan.triangles + plan.spheres, first = static_cast<uint32_t>(rng() % prims);
  for (uint32_t i = 0; i < prims; ++i) {
    const uint32_t prim = (first + i * 7919) % prims;
    if (plan.prim_bin[prim] == bin) return prim;
  }
  return first;
}

}  // namespace

void fill_camera_path(const Plan& plan, Rng& rng, Path<float>& p) {
  const uint32_t sample = 1000 * p.step.light;  // all paths of a batch are the same sample of their pixels
  start(plan, rng, p);
  p.sample = sample;
}

void fill_light_path(const Plan& plan, Rng& rng, Path<float>& p) {
  start(plan, rng, p);
  p.pixel = light_path_pixel(kFirstLightPath + p.slot);
  p.sample = light_path_sample(kFirstLightPath + p.slot);
}

void fill_ray(const Plan& plan, Rng& rng, Path<float>& p) {
  start(plan, rng, p);
  const dvec3 o = rng() % 4 == 0 ? reference::vec3<double>(plan.camera.eye) : point_in(rng);
  set_o(p, o);
  set_d(p, glm::normalize(hard_target(plan, rng, o) - o));
}

void fill_hit(const Plan& plan, Rng& rng, Path<float>& p) {
  Path<double> exact;
  do {
    fill_ray(plan, rng, p);
    p.beta_r += 0.01f;
    exact = convert_path<double>(p);
    reference::intersect(plan, exact);
  } while (exact.prim == kNoPrim);
  p = convert_path<float>(exact);
}

void fill_emitter_hit(const Plan& plan, Rng& rng, Path<float>& p) {
  start(plan, rng, p);
  p.prim = random_prim(plan, rng, kEmitter);
  const float* shape = &plan.prim_shape[size_t{4} * p.prim];
  dvec3 n = reference::vec3<double>(shape), at = point_in(rng);
  if (p.prim < plan.triangles) {
    at += (shape[3] - glm::dot(n, at)) * n;
  } else {
    const dvec3 center = n;
    n = random_unit(rng);
    at = center + double{shape[3]} * n;
  }
  const dvec3 d = near_or_grazing(rng, n);
  const double t = 0.01 + 3 * unit(rng);
  set_o(p, at - t * d);
  set_d(p, d);
  p.t = static_cast<float>(t);
  p.bin = kEmitter;
  if (rng() % 8 == 0) p.pdf = kConnected;
}

// Often beside a pole, the seam of the map or an axis.
void fill_sky_ray(const Plan& plan, Rng& rng, Path<float>& p) {
  start(plan, rng, p);
  dvec3 axis(0);
  axis[static_cast<int>(rng() % 3)] = either_sign(rng);
  set_d(p, rng() % 2 ? random_unit(rng) : glm::normalize(axis + small(rng, 8) * random_unit(rng)));
  if (rng() % 8 == 0) p.pdf = kConnected;
}

void fill_shading_point(const Plan& plan, Rng& rng, Path<float>& p) {
  fill_hit(plan, rng, p);
  Path<double> exact = convert_path<double>(p);
  reference::surface(plan, exact);
  p = convert_path<float>(exact);
  if (rng() % 2) {
    const dvec3 s = glm::normalize(dvec3(p.s_x, p.s_y, p.s_z));
    set_d(p, near_or_grazing(rng, s));
  }
}

// No point of a mirror or glass: of a sphere that is connected, it would be on the edge of seeing anything in it.
void fill_rough_point(const Plan& plan, Rng& rng, Path<float>& p) {
  do {
    fill_shading_point(plan, rng, p);
  } while (plan.prim_bin[p.prim] >= kRoughBins);
}

void fill_light_sample(const Plan& plan, Rng& rng, Path<float>& p) {
  fill_shading_point(plan, rng, p);
  const dvec3 s = glm::normalize(dvec3(p.s_x, p.s_y, p.s_z)), d(p.d_x, p.d_y, p.d_z);
  switch (rng() % 4) {
    case 0:
      sample_light(plan, p);
      break;
    case 1:  // about the mirror direction, where all the reflection of a narrow lobe is
      set_l(p, 0.7 * (d - 2 * glm::dot(d, s) * s + small(rng, 5) * random_unit(rng)));
      break;
    case 2:
      set_l(p, small(rng, 3) * near_or_grazing(rng, s));
      break;
    default:
      if (rng() % 4 == 0) set_l(p, dvec3(0)), p.l_pdf = 0;
      if (rng() % 4 == 0) set_l(p, 1e6 * s), p.l_pdf = 1e12f;
      break;
  }
}

void fill_shadow_ray(const Plan& plan, Rng& rng, Path<float>& p) {
  fill_shading_point(plan, rng, p);
  const dvec3 o(p.o_x, p.o_y, p.o_z);
  if (rng() % 2) {
    sample_light(plan, p);
  } else {
    set_l(p, (0.5 + unit(rng)) * (hard_target(plan, rng, o) - o));
  }
  if (rng() % 8 == 0) p.c_r = p.c_g = p.c_b = 0;
}

void fill_connection(const Plan& plan, Rng& rng, Path<float>& p) {
  fill_shadow_ray(plan, rng, p);
  const dvec3 o(p.o_x, p.o_y, p.o_z);
  const dvec3 l(p.l_x, p.l_y, p.l_z), between = rng() % 2 ? 0.5 * l : l;
  set_l(p, between);
  set(p.m_x, p.m_y, p.m_z, (0.5 + unit(rng)) * (hard_target(plan, rng, o + between) - o - between));
  if (!plan.connected_spheres.empty()) p.via = static_cast<uint32_t>(rng() % plan.connected_spheres.size());
}

void fill_throughput(const Plan& plan, Rng& rng, Path<float>& p) {
  start(plan, rng, p);
  const float scale = rng() % 4 == 0 ? 1e-20f : static_cast<float>(2 * unit(rng));
  p.beta_r *= scale, p.beta_g *= scale, p.beta_b *= scale;
}

void set_prim(const Plan& plan, Rng& rng, Path<float>& p, Bin bin) {
  p.prim = random_prim(plan, rng, bin);
  p.bin = bin;
}

}  // namespace lanewise::verify
