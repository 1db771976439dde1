#pragma once

#include "kernels/reference/fresnel.h"
#include "kernels/reference/microfacet.h"
#include "kernels/reference/rng.h"
#include "kernels/reference/sampling.h"
#include "kernels/reference/shading.h"

namespace lanewise::reference {

template <class T>
T alpha_of(const PlanMaterial& material) {
  return std::max(static_cast<T>(material.alpha), T(1e-6f));
}

template <class T>
Vec3<T> fresnel_conductor(const Plan& plan, const PlanMaterial& material, T c) {
  Vec3<T> f;
  for (int i = 0; i < 3; ++i) {
    f[i] = fresnel_conductor(plan.settings.fresnel, c, static_cast<T>(material.eta[i]), static_cast<T>(material.k[i]));
  }
  return f;
}

// A pair of directions above the surface: f cos without Fresnel, the cosine at the half vector, and wi's density under
// the plan's sampling strategy.
template <class T>
struct MicrofacetPair {
  T f_cos, f, cos_h, pdf;
};

template <class T>
SlopeView<T> view_slopes(const Vec3<T>& w, T alpha) {
  return {std::max(w.z, T(0)), std::sqrt(w.x * w.x + w.y * w.y), alpha};
}

template <class T>
MicrofacetPair<T> evaluate_microfacet(const Settings& settings, const Vec3<T>& wo, const Vec3<T>& wi, T alpha) {
  const Vec3<T> h = wo + wi;
  const T z = std::max(h.z, T(1e-6)), across2 = h.x * h.x + h.y * h.y, length2 = z * z + across2;
  const T d = beckmann_d(across2 / (z * z), alpha);
  const SlopeView<T> view_o = view_slopes(wo, alpha), view_i = view_slopes(wi, alpha);
  MicrofacetPair<T> pair;
  pair.cos_h = std::min(std::sqrt(length2) / 2, T(1));
  const T visible_pdf = d * view_o.g1_over_cos() / 4;
  pair.f_cos = visible_pdf * view_i.g1();
  pair.f = visible_pdf * view_i.g1_over_cos();
  if (settings.course.any()) {
    pair.f_cos = course_f_cos(settings.course, across2 / (z * z), alpha, view_o, view_i);
    pair.f = pair.f_cos / std::max(wi.z, T(1e-30f));
  }
  switch (settings.bsdf_sampling) {
    case BsdfSampling::kVndf:
      pair.pdf = visible_pdf;
      break;
    case BsdfSampling::kNdf:
      pair.pdf = d / 4 / std::max(length2 / (2 * z), T(1e-6));
      break;
    case BsdfSampling::kCosine:
      pair.pdf = wi.z * std::numbers::inv_pi_v<T>;
      break;
  }
  return pair;
}

template <class T>
void light_microfacet(const Plan& plan, Path<T>& p) {
  const Vec3<T> d = LANEWISE_VEC3(p, d), normal = viewer_side(LANEWISE_VEC3(p, s), d);
  const Vec3<T> l = glm::normalize(LANEWISE_VEC3(p, l));
  const PlanMaterial& material = material_at(plan, p);
  Vec3<T> b1, b2, c(0);
  frame(normal, b1, b2);
  const auto local = [&](const Vec3<T>& w) { return Vec3<T>(glm::dot(w, b1), glm::dot(w, b2), glm::dot(w, normal)); };
  Vec3<T> wo = local(-d);
  wo.z = std::max(wo.z, T(0));
  const Vec3<T> wi = local(l);
  if (wi.z > 0 && p.l_pdf > 0 && looks_for_light(plan, p, l)) {
    const auto pair = evaluate_microfacet(plan.settings, wo, wi, alpha_of<T>(material));
    c = LANEWISE_RGB(p, beta) * fresnel_conductor(plan, material, pair.cos_h) * pair.f_cos *
        light_weight(plan, p, pair.pdf);
  }
  LANEWISE_SET_RGB(p, c, c);
}

template <class T>
void shade_microfacet(const Plan& plan, Path<T>& p) {
  const Vec3<T> d = LANEWISE_VEC3(p, d), normal = viewer_side(LANEWISE_VEC3(p, s), d);
  const PlanMaterial& material = material_at(plan, p);
  const T alpha = alpha_of<T>(material);
  const BsdfSampling strategy = plan.settings.bsdf_sampling;
  Vec3<T> b1, b2;
  frame(normal, b1, b2);
  const Vec3<T> wo(-glm::dot(d, b1), -glm::dot(d, b2), std::max(-glm::dot(d, normal), T(0)));
  const auto [u, v] = draw_facet(plan, p);

  Vec3<T> wi;
  T cos_h, weight, pdf;
  if (strategy == BsdfSampling::kCosine) {
    wi = cosine_hemisphere(u, v);
    const auto pair = evaluate_microfacet(plan.settings, wo, wi, alpha);
    cos_h = pair.cos_h;
    weight = pair.f * std::numbers::pi_v<T>;
    pdf = pair.pdf;
  } else {
    const bool visible = strategy == BsdfSampling::kVndf;
    const Slopes<T> m = visible ? sample_visible_normal(wo, alpha, u, v) : sample_normal(alpha, u, v);
    const T tan2 = glm::dot(m, m);
    const T wo_m = wo.x * m.x + wo.y * m.y + wo.z;  // wo.m / m_z
    wi = 2 * wo_m / (1 + tan2) * Vec3<T>(m.x, m.y, 1) - wo;
    cos_h = std::min(wo_m / std::sqrt(1 + tan2), T(1));
    const SlopeView<T> view_o = view_slopes(wo, alpha), view_i = view_slopes(wi, alpha);
    const T distribution = beckmann_d(tan2, alpha);
    weight = visible ? view_i.g1() : view_i.g1() * view_o.g1_over_cos() * wo_m;
    pdf = visible ? distribution * view_o.g1_over_cos() / 4 : distribution / 4 / std::max(wo_m, T(1e-6));
    if (const CourseLobe& course = plan.settings.course; course.any()) {
      weight = course_f_cos(course, tan2, alpha, view_o, view_i) / std::max(pdf, T(1e-30f));
    }
  }
  const bool reflects = wi.z > 0 && cos_h > 0;
  leave(p, glm::normalize(to_world(wi, b1, b2, normal)),
        reflects ? weight * fresnel_conductor(plan, material, cos_h) : Vec3<T>(0), reflects ? pdf : T(0));
}

}  // namespace lanewise::reference
