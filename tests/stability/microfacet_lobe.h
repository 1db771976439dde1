// The microfacet kernels as functions of one white metal, on the target chosen at the moment, and Beckmann's formulas in
// double, by which they are judged. The normal is +z, and the viewer is in the xz plane.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

#include "core/settings.h"

namespace lanewise::test {

// A metal that reflects all, so that the lobe is D G / (4 cos cos) alone.
struct Lobe {
  double alpha;
  BsdfSampling sampling = Settings().bsdf_sampling;
  CourseLobe course = {};
};

struct LobeSample {
  glm::dvec3 wi;
  double weight;  // f cos / pdf; 0: the sample is void
  double pdf;     // per steradian
};

// n samples of shade_microfacet for a viewer at this cosine to the normal.
std::vector<LobeSample> sample_lobe(const Lobe& lobe, double cosine, uint32_t n);

// f cos of each direction by light_microfacet.
std::vector<double> evaluate_lobe(const Lobe& lobe, double cosine, const std::vector<glm::dvec3>& wi);

// The viewer's direction in the bits that the kernels get.
glm::dvec3 lobe_viewer(double cosine);

// Walter et al. 2007: D per steradian, eq. 25, and Smith's Lambda, of which eq. 27 is the 1 / (1 + Lambda).
inline double beckmann_d(double tan2, double alpha) {
  const double q = (1 + tan2) / alpha;
  return std::exp(-tan2 / (alpha * alpha)) * q * q / std::numbers::pi;
}
inline double beckmann_lambda(double tan, double alpha) {
  const double a = 1 / (alpha * tan);
  return (std::exp(-a * a) / (a * std::sqrt(std::numbers::pi)) - std::erfc(a)) / 2;
}
inline double beckmann_lambda(const glm::dvec3& w, double alpha) {
  return beckmann_lambda(std::hypot(w.x, w.y) / w.z, alpha);
}
inline double smith_g1(const glm::dvec3& w, double alpha) { return 1 / (1 + beckmann_lambda(w, alpha)); }

}  // namespace lanewise::test
