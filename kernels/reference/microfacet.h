// Scalar twin of kernels/microfacet-inl.h: Beckmann microfacets in the frame of the shading normal.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/settings.h"
#include "kernels/reference/vec3.h"

namespace lanewise::reference {

template <class T>
T beckmann_d(T tan2, T alpha) {
  const T q = (1 + tan2) / alpha;
  return std::exp(-tan2 / (alpha * alpha)) * q * q * std::numbers::inv_pi_v<T>;
}

// The unit-roughness surface as seen from a direction stretched to cosine c and sine s.
template <class T>
struct SlopeView {
  T c, s;
  T half;  // sqrt(pi) / 2 c
  T cut;   // slopes above it face away
  T area;  // integral of max(0, c - x s) e^(-x^2) over x

  SlopeView(T cosine, T sine, T alpha)
      : c(cosine),
        s(std::max(alpha * sine, T(1e-20))),
        half(c * std::sqrt(std::numbers::pi_v<T>) / 2),
        cut(std::min(c / s, T(10))),
        area(half * (2 - std::erfc(cut)) + s / 2 * std::exp(-cut * cut)) {}

  T g1() const { return 2 * half / area; }
  T g1_over_cos() const { return std::sqrt(std::numbers::pi_v<T>) / area; }
};

// The course program's departures: kernels/microfacet-inl.h.
template <class T>
T course_lambda(const SlopeView<T>& v) {
  return (std::exp(-v.cut * v.cut) * std::numbers::inv_pi_v<T> / v.cut - std::erfc(v.cut)) / 2;
}

template <class T>
T course_f_cos(const CourseLobe& course, T tan2, T alpha, const SlopeView<T>& wo, const SlopeView<T>& wi) {
  const T d = beckmann_d(course.clamp ? std::max(tan2, T(2.00003e-5f)) : tan2, alpha);
  const T g_over_cos = course.masking ? 1 / (1 + course_lambda(wo) + course_lambda(wi)) / std::max(wo.c, T(1e-6f))
                                      : wo.g1_over_cos() * wi.g1();
  return d / 4 * g_over_cos;
}

// The slope x below which lies the share u of the view's density: Halley's steps, each kept within a bracket that
// shrinks, until they end.
template <class T>
T visible_slope(const SlopeView<T>& v, T uniform) {
  const T u = std::max(uniform, T(0x1p-25));
  const auto value = [&](T z, T sigma) { return v.half * std::erfc(z) + sigma / 2 * std::exp(-z * z); };
  const bool lower = u * v.area <= v.half + v.s / 2;
  const T sigma = lower ? v.s : -v.s;
  const T target = lower ? u * v.area : (1 - u) * v.area + value(v.cut, sigma);
  T lo = 0, hi = lower ? T(5) : v.cut, z = std::min(hi / 2, T(1));
  for (int step = 0; step < 100; ++step) {
    const T excess = value(z, sigma) - target;
    (excess > 0 ? lo : hi) = z;
    const T slope = std::max(v.c + z * sigma, T(1e-20));
    const T newton = excess / (slope * std::exp(-z * z));
    const T next = z + newton / (1 + newton / 2 * (sigma / slope - 2 * z));
    if (std::abs(next - z) <= std::numeric_limits<T>::epsilon() * z) break;
    z = next > lo && next < hi ? next : (lo + hi) / 2;
  }
  return lower ? -z : z;
}

// Slopes (x, y) of a microfacet: its normal is (x, y, 1) / sqrt(1 + x^2 + y^2).
template <class T>
using Slopes = glm::vec<2, T>;

template <class T>
Slopes<T> sample_normal(T alpha, T u, T v) {
  const T phi = 2 * std::numbers::pi_v<T> * v;
  return alpha * std::sqrt(-std::log1p(-u)) * Slopes<T>(std::cos(phi), std::sin(phi));
}

template <class T>
Slopes<T> sample_visible_normal(const Vec3<T>& wo, T alpha, T u, T v) {
  const T sine = std::sqrt(wo.x * wo.x + wo.y * wo.y);
  const T along = -visible_slope(SlopeView<T>(wo.z, sine, alpha), u);
  const T across = visible_slope(SlopeView<T>(1, 0, 1), v);  // seen from above: the Gauss distribution itself
  const bool tilted = sine > T(1e-5f);
  const T cos = tilted ? wo.x / sine : 1, sin = tilted ? wo.y / sine : 0;
  return alpha * Slopes<T>(cos * along - sin * across, sin * along + cos * across);
}

}  // namespace lanewise::reference
