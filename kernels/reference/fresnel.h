// Scalar twin of kernels/fresnel-inl.h. Reflectance of unpolarised light, the mean of both polarisations.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/settings.h"

namespace lanewise::reference {

template <class T>
T square(T x) {
  return x * x;
}

template <class T>
T schlick_fresnel(T f0, T c) {
  const T m = 1 - c;
  return f0 + (1 - f0) * square(square(m)) * m;
}

template <class T>
struct Dielectric {
  T reflectance;    // in [0, 1]; exactly 1 under total internal reflection
  T transmittance;  // 1 - reflectance, of the exact formulas without cancellation
  T cos_t;          // of the refracted direction against the normal; 0 under total internal reflection
};

// c: cosine of incidence in [0, 1], on the side of index n_i.
template <class T>
Dielectric<T> fresnel_dielectric(Fresnel model, T c, T n_i, T n_t) {
  const T n_i2 = n_i * n_i, n_t2 = n_t * n_t;
  const T e = (n_t - n_i) * (n_t + n_i);
  const T g2 = e + square(n_i * c);  // (n_t cos_t)^2
  if (!(g2 > 0)) return {1, 0, 0};
  const T g = std::sqrt(g2), cos_t = std::min(g / n_t, T(1));
  if (model == Fresnel::kExact) {
    // Amplitudes (n_i c - g) / (n_i c + g) and (n_t^2 c - n_i g) / (n_t^2 c + n_i g). Multiplied above and below by
    // their denominators, the numerators turn into differences of squares in which e factors out: nothing cancels as e
    // -> 0.
    const T s2 = square(n_i * c + g), p2 = square(n_t2 * c + n_i * g);
    const T rs = e / s2;
    const T rp = e * ((n_t2 + n_i2) * c * c - n_i2) / p2;
    // What is left of the squared amplitudes are products, 4 n_i c g and 4 n_t^2 c n_i g.
    return {std::min((rs * rs + rp * rp) / 2, T(1)), 2 * n_i * c * g * (1 / s2 + n_t2 / p2), cos_t};
  }
  const T f0 = square((n_i - n_t) / (n_i + n_t));
  const T reflectance = schlick_fresnel(f0, model == Fresnel::kSchlick && n_i > n_t ? cos_t : c);
  return {reflectance, 1 - reflectance, cos_t};
}

// One channel of a conductor with index eta + i k; c in [0, 1].
template <class T>
T fresnel_conductor(Fresnel model, T c, T eta, T k) {
  const T c2 = c * c, k2 = k * k;
  if (model == Fresnel::kExact) {
    // a + i b = sqrt((eta + i k)^2 - s^2); Rs = |(a + i b - c) / (a + i b + c)|^2 and
    // Rp / Rs = |((a + i b) c - s^2) / ((a + i b) c + s^2)|^2 (Born & Wolf, ch. 14).
    const T s2 = 1 - c2, ab2 = square(eta * k);
    const T t0 = (eta - 1) * (eta + 1) + (c - k) * (c + k);  // eta^2 - k^2 - s^2
    const T larger = (std::sqrt(t0 * t0 + 4 * ab2) + std::abs(t0)) / 2;
    const T smaller = ab2 / std::max(larger, T(1e-30));
    const T a2 = t0 >= 0 ? larger : smaller, b2 = t0 >= 0 ? smaller : larger;
    const T a = std::sqrt(a2), little = T(1e-18);
    const T rs_top = square(a - c) + b2 + little, rs_bottom = square(a + c) + b2 + little;
    const T top = c2 * (a2 + b2) + s2 * s2 + little, bottom = square(a * c + s2) + c2 * b2 + little;
    return std::min(rs_top * top / (rs_bottom * bottom), T(1));
  }
  if (model == Fresnel::kSchlick) {
    return schlick_fresnel((square(eta - 1) + k2) / (square(eta + 1) + k2), c);
  }
  const T m2 = eta * eta + k2, cross = 2 * eta * c;
  const T rs = (m2 + c2 - cross) / std::max(m2 + c2 + cross, T(1e-30));
  const T rp = (m2 * c2 + 1 - cross) / (m2 * c2 + 1 + cross);
  return std::clamp((rs + rp) / 2, T(0), T(1));
}

}  // namespace lanewise::reference
